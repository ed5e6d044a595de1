/**
 * Where the editor lives in viser's page: over the 3D area, outside the element whose pointer events move
 * viser's camera, below its floating panels. viser may build that area anew at any time.
 *
 * @module
 */

const HOST_ID = "fairyring-editor";

/**
 * The element everything of the editor is put into; the same one for the life of the page.
 *
 * @returns {HTMLElement}
 */
export function createHost() {
  const host = document.createElement("div");
  host.id = HOST_ID;
  host.tabIndex = 0;
  host.setAttribute("role", "application");
  host.setAttribute(
    "aria-label",
    "Photo with the outlines of the caps. Press the question mark for the keys.",
  );
  return host;
}

/**
 * Keeps the host in the 3D area and tells when the page holds a new token.
 *
 * @param {HTMLElement} host
 * @param {(token: string) => void} onToken
 */
export function keepMounted(host, onToken) {
  let token = "";
  const look = () => {
    mount(host);
    const found = document.getElementById("fairyring-tab")?.dataset.token ?? "";
    if (found && found !== token) onToken((token = found));
  };
  look();
  freePanel(host);
  new MutationObserver(look).observe(document.body, {
    childList: true,
    subtree: true,
    attributes: true,
    attributeFilter: ["data-token"],
  });
}

/** The panel has the width that the style sheet keeps for it until somebody takes hold of it. @type {(host: HTMLElement) => void} */
function freePanel(host) {
  /** @type {(event: Event) => void} */
  const held = ({ target }) => {
    const within = target instanceof Element && target.closest("[data-dock-root]") && !host.contains(target);
    // Before the panel has its own width, nobody has had anything to take hold of.
    if (!within || !document.querySelector("[data-dock-region] [role=tab]")) return;
    document.documentElement.dataset.fairyringPanel = "free";
    for (const kind of ["pointerdown", "keydown"]) document.removeEventListener(kind, held, true);
  };
  for (const kind of ["pointerdown", "keydown"]) document.addEventListener(kind, held, true);
}

/** @type {(host: HTMLElement) => void} */
function mount(host) {
  const canvas = document.querySelector("canvas[data-engine]");
  const area = canvas?.closest("[data-dock-root] > *") ?? null;
  if (!area || host.parentElement === area) return;
  area.setAttribute("data-fairyring-area", "");
  area.append(host);
}

/** @type {() => boolean} */
export function hasWebGL() {
  const canvas = document.createElement("canvas");
  return Boolean(canvas.getContext("webgl2") ?? canvas.getContext("webgl"));
}
