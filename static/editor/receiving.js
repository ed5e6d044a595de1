import { showJob } from "./ui/job_lines.js";

/** @typedef {import("./protocol.js").FromServer} FromServer */

/**
 * @typedef {Object} Parts
 * @property {import("./state/editor_state.js").EditorState} state
 * @property {import("./sync/sync.js").Sync} sync
 * @property {import("./reviewing.js").Reviewing} reviewing
 * @property {import("./repeating.js").Repeating} repeating
 * @property {import("./sync/live_fit.js").LiveFit} liveFit
 * @property {import("./sync/cap_requests.js").CapRequests} found
 * @property {import("./opening.js").Opening} opening
 * @property {(name: string) => boolean} perform
 * @property {import("./ui/notices.js").Say} say
 * @property {() => string} user  whose page this is
 * @property {() => void} progress  shows what waits, and the status
 */

/** A button that takes the status of an image back, while that is what was done there last. @type {(sync: import("./sync/sync.js").Sync, image: number | null) => (import("./ui/notices.js").Remedy & import("./ui/notices.js").Going) | null} */
function undoing(sync, image) {
  if (image === null || !sync.hasFinished(image)) return null;
  return {
    word: "Undo",
    about: "decision",
    act: (close) => {
      close();
      if (sync.hasFinished(image)) sync.undoOn(image);
    },
  };
}

/** Hands what the server says to whom it concerns. @type {(parts: Parts) => (message: FromServer) => void} */
export function receiver({ state, sync, reviewing, repeating, liveFit, found, opening, perform, say, user, progress }) {
  return (message) => {
    sync.heard();
    switch (message.type) {
      case "show":
        opening.show(message);
        reviewing.ask();
        return progress();
      case "outcomes":
        sync.receive(message.outcomes);
        if (message.outcomes.some(({ outcome }) => outcome !== "status")) reviewing.ask();
        return;
      case "compared":
        sync.changed(message.image, message.turned_down);
        return reviewing.take(message);
      case "mark_again":
        return void repeating.take(message);
      case "kept_again":
        return repeating.kept(message.id);
      case "status":
        return sync.statusChanged(message.image, message.status, message.user === user());
      case "recalled":
        return sync.recalled(message);
      case "changed":
        sync.changed(message.image, message.annotations);
        return reviewing.ask();
      case "predicted":
        if (message.image === state.image?.id) state.predict(message.predictions);
        return reviewing.ask();
      case "found_cap":
        return found.take(message);
      case "fit":
        return liveFit.take(message);
      case "progress":
        return showJob(message);
      case "command":
        return void perform(message.name);
      case "notice":
        return say(message.text, message.level, undoing(sync, message.undo));
    }
  };
}
