/**
 * What the editor says to the server.
 *
 * @module
 */

/** @typedef {import("./records.js").Cap} Cap */
/** @typedef {import("./records.js").Circle} Circle */
/** @typedef {import("./records.js").Edit} Edit */
/** @typedef {import("./records.js").Point} Point */
/** @typedef {import("./records.js").Polygon} Polygon */
/** @typedef {import("./records.js").StatusEdit} StatusEdit */
/** @typedef {import("./records.js").Verdict} Verdict */
/** @typedef {import("./records.js").Way} Way */

/**
 * @typedef {Object} Hello
 * @property {"hello"} type
 * @property {string} token
 * @property {number | null} image
 */

/**
 * @typedef {Object} Open
 * @property {"open"} type
 * @property {number} image
 * @property {string | null} select
 */

/**
 * @typedef {Object} Step
 * @property {"step"} type
 * @property {-1 | 1} by
 */

/**
 * @typedef {Object} Edits
 * @property {"edits"} type
 * @property {Edit[]} edits
 * @property {StatusEdit[]} statuses
 * @property {Verdict[]} verdicts
 */

/**
 * @typedef {Object} Refit
 * @property {"refit"} type
 * @property {number} seq
 * @property {number} image
 * @property {string} annotation
 * @property {Cap} cap
 */

/**
 * @typedef {Object} Select
 * @property {"select"} type
 * @property {string[]} annotations
 * @property {number[]} predictions
 */

/**
 * @typedef {Object} Recall
 * @property {"recall"} type
 * @property {number} image
 * @property {Way} way
 * @property {number | null} change_set
 */

/**
 * @typedef {Object} Saving
 * @property {"saving"} type
 * @property {number} waiting
 */

/**
 * @typedef {Object} Window
 * @property {"window"} type
 * @property {boolean} dark
 * @property {number} width
 */

/**
 * @typedef {Object} Compare
 * @property {"compare"} type
 * @property {number} image
 */

/**
 * @typedef {Object} ShowCaps
 * @property {"show_caps"} type
 * @property {"worst" | "matched" | "missed" | "extra" | "doubtful" | "unsure" | "ignored"} kind
 * @property {Group | null} group
 */

/**
 * @typedef {Object} Group
 * @property {"light" | "form" | "size" | "visibility" | "shape" | "annotator" | "image" | "run"} by
 * @property {string | null} value
 * @property {number | null} image
 * @property {number | null} beside
 */

/**
 * @typedef {Object} CompareWith
 * @property {"compare_with"} type
 * @property {number} run
 */

/**
 * @typedef {Object} AskAgain
 * @property {"ask_again"} type
 * @property {boolean} quiet
 */

/**
 * @typedef {Object} MarkedAgain
 * @property {"marked_again"} type
 * @property {string} id
 * @property {string} annotation
 * @property {boolean} mirrored
 * @property {Circle | Polygon} mark
 */

/**
 * @typedef {Object} FindCap
 * @property {"find_cap"} type
 * @property {number} seq
 * @property {number} image
 * @property {Point[]} points
 * @property {boolean[]} wanted
 * @property {[number, number, number, number] | null} box
 * @property {string | null} besides
 */

/**
 * @typedef {Object} Tag
 * @property {"tag"} type
 * @property {number} image
 * @property {string | null} light
 * @property {string | null} form
 * @property {string | null} split
 */

/**
 * @typedef {Object} Predict
 * @property {"predict"} type
 * @property {number} image
 */

/**
 * @typedef {Object} Cancel
 * @property {"cancel"} type
 * @property {number} job
 */

/** @typedef {Hello | Open | Step | Edits | Refit | Select | Recall | Saving | Window | Tag | Predict | Cancel | FindCap | Compare | CompareWith | ShowCaps | AskAgain | MarkedAgain} ToServer */

export {};
