/**
 * Photos dropped anywhere on the page, or chosen, are sent to the server one after the other, with a bar that
 * says how far that is.
 *
 * @module
 */

import { element } from "./dom.js";

/** @typedef {import("./notices.js").Say} Say */

const ADDRESS = "/uploads";

/** @type {(host: HTMLElement, say: Say) => void} */
export function takePhotos(host, say) {
  const send = sendingIn(host, say);
  const chooser = element("input", { attributes: { type: "file", multiple: "", accept: "image/*" } });
  chooser.addEventListener("change", () => {
    void send([...(chooser.files ?? [])]);
    chooser.value = "";
  });
  document.addEventListener("click", ({ target }) => {
    if (target instanceof Element && target.closest("[data-fairyring-upload]")) chooser.click();
  });
  const hasFiles = (/** @type {DragEvent} */ event) => event.dataTransfer?.types.includes("Files") ?? false;
  for (const type of /** @type {const} */ (["dragover", "drop"]))
    window.addEventListener(type, (event) => hasFiles(event) && event.preventDefault());
  window.addEventListener("dragover", (event) => host.toggleAttribute("data-fairyring-drop", hasFiles(event)));
  window.addEventListener("dragleave", ({ relatedTarget }) => {
    if (!relatedTarget) host.removeAttribute("data-fairyring-drop");
  });
  window.addEventListener("drop", (event) => {
    host.removeAttribute("data-fairyring-drop");
    void send([...(event.dataTransfer?.files ?? [])]);
  });
}

/** @type {(host: HTMLElement, say: Say) => (files: File[]) => Promise<void>} */
function sendingIn(host, say) {
  const words = element("span");
  const bar = element("progress", { attributes: { "aria-label": "Photos on their way" } });
  const box = element("div", { class: "fairyring-uploads", attributes: { role: "status" } }, words, bar);
  box.dataset.fairyringChrome = "";
  box.hidden = true;
  host.append(box);
  return async (files) => {
    if (!files.length) return;
    const total = files.reduce((sum, { size }) => sum + size, 0);
    let sent = 0;
    let added = 0;
    let refused = 0;
    box.hidden = false;
    bar.max = Math.max(total, 1);
    for (const [nth, file] of files.entries()) {
      words.textContent = `Photo ${nth + 1} of ${files.length}: ${file.name}`;
      try {
        added += await sendOne(file, (bytes) => (bar.value = sent + bytes));
      } catch (error) {
        refused += 1;
        say(`${file.name}: ${error instanceof Error ? error.message : error}`, "error");
      }
      sent += file.size;
    }
    box.hidden = true;
    const known = files.length - added - refused;
    say(`${count(added)} taken in${known ? `, ${known} there already` : ""}.`, "info");
  };
}

/**
 * How many photos it added: none where the project has it.
 *
 * @type {(file: File, sent: (bytes: number) => void) => Promise<number>}
 */
function sendOne(file, sent) {
  return new Promise((resolve, reject) => {
    // fetch does not tell how far an upload is.
    const request = new XMLHttpRequest();
    request.open("POST", ADDRESS);
    request.setRequestHeader("X-File-Name", encodeURIComponent(file.name));
    request.upload.addEventListener("progress", ({ loaded }) => sent(Math.min(loaded, file.size)));
    request.addEventListener("error", () => reject(new Error("The server cannot be reached.")));
    request.addEventListener("load", () =>
      request.status === 200
        ? resolve(JSON.parse(request.responseText).added)
        : reject(new Error(request.responseText)),
    );
    request.send(file);
  });
}

/** @type {(photos: number) => string} */
function count(photos) {
  return `${photos} photo${photos === 1 ? "" : "s"}`;
}
