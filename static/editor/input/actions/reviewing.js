/**
 * What a reviewer does: walk through what differs, decide on caps, say something of the image.
 *
 * @module
 */

import DECLARED from "../../commands.js";
import { changed } from "../../state/changes.js";
import { decideOn, partnerOf, takePrediction } from "../../state/deciding.js";
import { uidOf } from "../../state/review.js";
import { Standing, lookAt } from "../../state/standing.js";
import { finishAs } from "./image.js";

/** @typedef {import("../../protocol.js").Says} Says */
/** @typedef {import("./context.js").Context} Context */

const SENDING_BACK = DECLARED.groups.flatMap(({ commands }) => commands).find(({ name }) => name === "send_back");
const ALL_DECIDED = "Nothing else differs here.";
const NONE_SELECTED = "Select a cap that differs first, with “.”.";

/** @type {(context: Context) => void} */
export function toggleReview({ review }) {
  review.on = !review.on;
}

/** @type {(context: Context, by: 1 | -1) => Promise<void>} */
export async function walkDifferences({ state, review, say }, by) {
  state.commitDrafts();
  const { image } = state;
  if (!image) return;
  review.on = true;
  await review.known(image.id);
  if (state.image?.id !== image.id) return;
  const next = new Standing(state, review).next(by);
  if (next) lookAt(state, next);
  else say(ALL_DECIDED);
}

/** Has the selected cap be as the network said. @type {(context: Context) => void} */
export function takeModels(context) {
  decide(context, (_, cap) => takePrediction(context.state, context.review, cap));
}

/** The person was right: the cap is approved, a prediction without a cap turned down. @type {(context: Context) => void} */
export function takeAnnotators(context) {
  decide(context, (shape, cap) => {
    const annotation = cap.annotation ?? partnerOf(context.state, context.review, cap)?.annotation;
    if (annotation) context.judge(annotation, "approved", "");
    else context.state.commit([changed(shape, { ...shape, deleted: true })]);
  });
}

/** @type {(context: Context, carryOut: (shape: import("../../geometry/shapes.js").Shape, cap: import("../../protocol.js").ComparedCap) => void) => void} */
function decide({ state, review, say }, carryOut) {
  state.commitDrafts();
  const [cap, [shape]] = [review.selected(state), state.selected];
  if (!cap || !shape) return say(NONE_SELECTED);
  decideOn(state, review, cap, () => carryOut(shape, cap));
  const next = new Standing(state, review).after(uidOf(cap));
  if (next) lookAt(state, next);
  else say(ALL_DECIDED);
}

/** @type {(context: Context) => Promise<void>} */
export async function approveAndGoOn(context) {
  if (await finishAs(context, "approved")) context.send({ type: "step", by: 1 });
}

/** @type {(context: Context) => Promise<void>} */
export async function sendBack(context) {
  const reasons = ["Caps are missing", "Caps that are none", "Outlines are off", "Marks are off"];
  const question = "What is to be done about it?";
  await say(context, "sent_back", { title: "Send {} back: what is to be done?", question, verb: SENDING_BACK?.label ?? "", reasons });
}

/** @type {(context: Context) => Promise<void>} */
export async function reject(context) {
  const reasons = ["Out of focus", "Too dark or too bright", "Caps are covered or cut off", "No mushrooms", "The same photo twice"];
  await say(context, "rejected", { title: "Reject {}: why?", question: "Why is it rejected?", verb: "Reject", reasons });
}

/** @type {(context: Context) => Promise<void>} */
export async function comment(context) {
  await say(context, "comment", { title: "Comment on {}", question: "Comment", verb: "Comment on", reasons: [] });
}

/**
 * Of the selected cap or the image; what is said of the image leads on to the next. `{}` in the title is the image.
 *
 * @type {(context: Context, says: Says, how: Pick<import("../../state/review.js").WordsQuestion, "title" | "question" | "verb" | "reasons">) => Promise<void>}
 */
async function say({ state, askWords, judge, send }, says, how) {
  state.commitDrafts();
  const { image } = state;
  const uid = state.selection.soleUid;
  const cap = uid !== null && state.store.get(uid) ? uid : null;
  if (!image) return;
  const title = how.title.replace("{}", () => image.file_name);
  const said = await askWords({ ...how, title, cap: cap !== null, first: says === "comment" ? "cap" : "image" });
  if (!said || state.image?.id !== image.id) return;
  const stored = await judge(said.about === "cap" ? cap : null, says, said.words);
  const goesOn = said.about === "image" && says !== "comment";
  if (stored && goesOn && state.image?.id === image.id) send({ type: "step", by: 1 });
}
