/** @typedef {import("../../protocol.js").Status} Status */
/** @typedef {import("../../protocol.js").ToServer} ToServer */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("../tools/tool.js").Tool} Tool */
/** @typedef {import("../../state/finishing.js").Question} Question */
/** @typedef {import("../../state/review.js").Said} Said */
/** @typedef {import("../../state/review.js").WordsQuestion} WordsQuestion */

/**
 * @typedef {Object} Context  what commands work with
 * @property {EditorState} state
 * @property {() => Tool} tool
 * @property {(name: string) => void} use  takes up a tool
 * @property {() => import("../../protocol.js").Point} pointer  where it is, image pixels
 * @property {(bounds: import("../../geometry/bounds.js").Bounds) => Promise<import("../../geometry/tightening.js").Patch>} patch  of the photo
 * @property {(box: [number, number, number, number], besides: string) => Promise<number[] | null>} rimIn  where the network sees one
 * @property {(shape: import("../../geometry/shapes.js").Shape) => import("../../protocol.js").Cap | null} suggested  the cap as it is offered to be
 * @property {() => void} drawPart  of the selected cap
 * @property {() => void} finish  closes the outline that is half drawn
 * @property {() => void} undo
 * @property {() => void} redo
 * @property {(status: Status) => Promise<boolean>} setStatus  of the image on screen; whether it was not refused
 * @property {(annotation: string | null, says: import("../../protocol.js").Says, words: string) => Promise<boolean>} judge  says something of the image on screen, or of a cap of it; whether it was not refused
 * @property {import("../../state/review.js").Review} review
 * @property {() => void} blink  draws annotations and predictions in turn, or both again
 * @property {(how: {quiet: boolean}) => void} markAgain  asks for caps that are to be marked again
 * @property {(question: Question) => Promise<import("../../state/finishing.js").Answer>} ask
 * @property {(question: WordsQuestion) => Promise<Said | null>} askWords
 * @property {() => Promise<number | null>} askScore  from which score on predictions are meant; null for none
 * @property {(message: ToServer) => boolean} send
 * @property {(layer: string) => void} toggle  shows or hides a layer
 * @property {() => void} switchFocus  from the photo to the panel, and back
 * @property {() => void} help
 * @property {() => void} tour  begins it, or ends it
 * @property {(text: string) => void} say
 */

/** @typedef {(context: Context) => unknown} Action  false where there was nothing to do, and the key is the browser's */

export {};
