/**
 * Starts the editor in viser's page.
 *
 * @module
 */

import { element } from "./ui/dom.js";
import { Editor } from "./editor.js";
import { createHost, hasWebGL, keepMounted } from "./ui/viser_host.js";

if (hasWebGL()) {
  const host = createHost();
  const { protocol, host: server } = window.location;
  const editor = new Editor(host, `${protocol === "https:" ? "wss" : "ws"}://${server}/editor`);
  keepMounted(host, (token) => editor.offer(token));
} else {
  const text =
    "Fairyring's page needs WebGL, and this browser offers none. Turn on hardware acceleration in the browser's settings, or use another browser.";
  document.body.append(element("div", { class: "fairyring-nowebgl", text, attributes: { role: "alert" } }));
}
