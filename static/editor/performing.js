import { toImage } from "./geometry/view.js";
import { ACTIONS } from "./input/actions.js";
import { switchFocus } from "./input/focus.js";
import { keyList } from "./ui/help.js";
import { ask } from "./ui/question.js";
import { tourIn } from "./ui/tour.js";
import { askWords } from "./ui/words_asked.js";

/** @typedef {import("./input/actions/context.js").Context} Context */
/** @typedef {import("./input/pointer.js").Pointer} Pointer */
/** @typedef {import("./input/toolbox.js").Toolbox} Toolbox */
/** @typedef {import("./input/rim_suggestion.js").RimSuggestion} RimSuggestion */
/** @typedef {import("./sync/sync.js").Sync} Sync */

/**
 * @typedef {Object} Own
 * @property {HTMLElement} host
 * @property {Toolbox} toolbox
 * @property {Sync} sync
 * @property {Pointer} pointer
 * @property {RimSuggestion} suggestion
 * @property {import("./reviewing.js").Reviewing} reviewing
 * @property {import("./repeating.js").Repeating} repeating
 */

/**
 * Carries out commands by name; false for one that nobody knows, or that has nothing to do.
 *
 * @type {(parts: Own & Pick<Context, "state" | "send" | "say" | "toggle" | "askScore" | "patch" | "rimIn">) => (name: string) => boolean}
 */
export function performer({ host, toolbox, sync, pointer, suggestion, reviewing, repeating, ...passed }) {
  /** @type {Context} */
  const context = {
    ...passed,
    tool: () => toolbox.tool,
    use: (name) => toolbox.use(name),
    pointer: () => toImage(passed.state.viewport.view, ...pointer.at),
    suggested: (shape) => suggestion.of(shape),
    drawPart: () => toolbox.drawPart(),
    finish: () => toolbox.finish(),
    undo: () => sync.undo(),
    redo: () => sync.redo(),
    setStatus: (status) => sync.say(status),
    judge: (annotation, says, words) => sync.judge(annotation, says, words),
    review: reviewing.review,
    blink: () => reviewing.blink(),
    markAgain: (how) => repeating.ask(how),
    ask,
    askWords,
    switchFocus: () => switchFocus(host),
    help: keyList(),
    tour: tourIn(host, passed.state),
  };
  return (name) => {
    const action = Object.hasOwn(ACTIONS, name) ? ACTIONS[name] : null;
    return action !== null && action(context) !== false;
  };
}
