/**
 * What the editor and the server say to each other: the JSON of `app/protocol` and `storage/records.py` as JSDoc
 * types. A test compares the two.
 *
 * @module
 */

/** @typedef {import("./messages/records.js").Point} Point */
/** @typedef {import("./messages/records.js").Outline} Outline */
/** @typedef {import("./messages/records.js").Whole} Whole */
/** @typedef {import("./messages/records.js").Mark} Mark */
/** @typedef {import("./messages/records.js").Status} Status */
/** @typedef {import("./messages/records.js").Circle} Circle */
/** @typedef {import("./messages/records.js").Ellipse} Ellipse */
/** @typedef {import("./messages/records.js").Polygon} Polygon */
/** @typedef {import("./messages/records.js").Image} Image */
/** @typedef {import("./messages/records.js").ToldArc} ToldArc */
/** @typedef {import("./messages/records.js").Cap} Cap */
/** @typedef {import("./messages/records.js").Annotation} Annotation */
/** @typedef {import("./messages/records.js").Prediction} Prediction */
/** @typedef {import("./messages/records.js").Run} Run */
/** @typedef {import("./messages/records.js").Edit} Edit */
/** @typedef {import("./messages/records.js").StatusEdit} StatusEdit */
/** @typedef {import("./messages/records.js").Says} Says */
/** @typedef {import("./messages/records.js").Verdict} Verdict */
/** @typedef {import("./messages/records.js").Accepted} Accepted */
/** @typedef {import("./messages/records.js").Conflict} Conflict */
/** @typedef {import("./messages/records.js").Refused} Refused */
/** @typedef {import("./messages/records.js").StatusStored} StatusStored */
/** @typedef {import("./messages/records.js").Outcome} Outcome */
/** @typedef {import("./messages/records.js").Way} Way */
/** @typedef {import("./messages/records.js").Return} Return */
/** @typedef {import("./messages/records.js").Reversal} Reversal */
/** @typedef {import("./messages/records.js").VerdictToWithdraw} VerdictToWithdraw */
/** @typedef {import("./messages/records.js").ImageContents} ImageContents */

/** @typedef {import("./messages/to_server.js").Hello} Hello */
/** @typedef {import("./messages/to_server.js").Open} Open */
/** @typedef {import("./messages/to_server.js").Step} Step */
/** @typedef {import("./messages/to_server.js").Edits} Edits */
/** @typedef {import("./messages/to_server.js").Refit} Refit */
/** @typedef {import("./messages/to_server.js").Select} Select */
/** @typedef {import("./messages/to_server.js").Recall} Recall */
/** @typedef {import("./messages/to_server.js").Saving} Saving */
/** @typedef {import("./messages/to_server.js").Window} Window */
/** @typedef {import("./messages/to_server.js").Compare} Compare */
/** @typedef {import("./messages/to_server.js").CompareWith} CompareWith */
/** @typedef {import("./messages/to_server.js").ShowCaps} ShowCaps */
/** @typedef {import("./messages/to_server.js").Group} Group */
/** @typedef {import("./messages/to_server.js").FindCap} FindCap */
/** @typedef {import("./messages/to_server.js").Tag} Tag */
/** @typedef {import("./messages/to_server.js").Predict} Predict */
/** @typedef {import("./messages/to_server.js").Cancel} Cancel */
/** @typedef {import("./messages/to_server.js").AskAgain} AskAgain */
/** @typedef {import("./messages/to_server.js").MarkedAgain} MarkedAgain */
/** @typedef {import("./messages/to_server.js").ToServer} ToServer */

/** @typedef {import("./messages/from_server.js").Welcome} Welcome */
/** @typedef {import("./messages/from_server.js").Show} Show */
/** @typedef {import("./messages/from_server.js").Outcomes} Outcomes */
/** @typedef {import("./messages/from_server.js").Working} Working */
/** @typedef {import("./messages/from_server.js").StatusChanged} StatusChanged */
/** @typedef {import("./messages/from_server.js").Recalled} Recalled */
/** @typedef {import("./messages/from_server.js").Changed} Changed */
/** @typedef {import("./messages/from_server.js").Predicted} Predicted */
/** @typedef {import("./messages/from_server.js").ComparedCap} ComparedCap */
/** @typedef {import("./messages/from_server.js").Compared} Compared */
/** @typedef {import("./messages/from_server.js").MarkAgain} MarkAgain */
/** @typedef {import("./messages/from_server.js").KeptAgain} KeptAgain */
/** @typedef {import("./messages/from_server.js").FoundCap} FoundCap */
/** @typedef {import("./messages/from_server.js").Arc} Arc */
/** @typedef {import("./messages/from_server.js").Fit} Fit */
/** @typedef {import("./messages/from_server.js").Fitted} Fitted */
/** @typedef {import("./messages/from_server.js").JobProgress} JobProgress */
/** @typedef {import("./messages/from_server.js").Command} Command */
/** @typedef {import("./messages/from_server.js").Notice} Notice */
/** @typedef {import("./messages/from_server.js").FromServer} FromServer */

export {};
