/**
 * Which outbox is this tab's. Each tab writes its own; what a closed tab left behind is taken over by the
 * next one that opens the project.
 *
 * @module
 */

import { newId } from "../ids.js";
import { browserStorage } from "./browser_storage.js";
import { Outbox } from "./outbox.js";
import { keysWith } from "./stored_edits.js";
import { lock } from "./tab_lock.js";

const ROOT = "fairyring:outbox:";
/** A page that is left lets go of its lock a moment after the next one has come. */
const LEAVING_MS = 1500;

/**
 * @param {string} project
 * @param {() => void} adopted  edits of a page that was just being left were taken over later
 * @returns {Promise<Outbox>}
 */
export async function openOutbox(project, adopted) {
  const storage = browserStorage();
  const root = `${ROOT}${project}:`;
  const own = `${root}${await ownName(root)}:`;
  const outbox = new Outbox(storage, own);
  const others = new Set(keysWith(storage, root).map((key) => key.slice(0, key.lastIndexOf(":") + 1)));
  others.delete(own);
  for (const prefix of others) {
    if (await abandoned(prefix)) outbox.adopt(prefix);
    else void adoptLater(outbox, prefix).then((late) => late && adopted());
  }
  return outbox;
}

/**
 * A name that survives a reload of this tab. A duplicated tab finds the lock on its copy taken and makes
 * a name of its own.
 *
 * @param {string} root
 * @returns {Promise<string>}
 */
async function ownName(root) {
  const remembered = sessionStorage.getItem(root);
  if (remembered && (await lock(`${root}${remembered}:`, { wait_ms: LEAVING_MS }))) return remembered;
  const name = newId();
  sessionStorage.setItem(root, name);
  await lock(`${root}${name}:`);
  return name;
}

/**
 * Looks once more when whoever was leaving has left. One that is only being loaded anew has its lock again.
 *
 * @type {(outbox: Outbox, prefix: string) => Promise<boolean>}
 */
async function adoptLater(outbox, prefix) {
  await new Promise((resolve) => setTimeout(resolve, LEAVING_MS));
  const left = await abandoned(prefix);
  if (left) outbox.adopt(prefix);
  return left;
}

/** @type {(prefix: string) => Promise<boolean>} */
async function abandoned(prefix) {
  if (!navigator.locks) return true;
  return navigator.locks.request(prefix, { ifAvailable: true }, (taken) => taken !== null);
}
