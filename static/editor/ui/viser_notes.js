/**
 * viser warns of WebGL without a graphics card: over the photo, at every visit, and until the note is closed.
 * The editor draws without WebGL.
 *
 * @module
 */

import { keptUp } from "./following.js";

const NOTE = ".mantine-Notification-root";

export function hideNoteOnSlowWebGL() {
  keptUp(() => {
    for (const note of document.querySelectorAll(NOTE))
      if (note instanceof HTMLElement && note.textContent?.includes("Software WebGL")) note.style.display = "none";
  })();
}
