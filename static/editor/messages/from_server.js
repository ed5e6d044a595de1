/**
 * What the server says to the editor.
 *
 * @module
 */

/** @typedef {import("./records.js").Annotation} Annotation */
/** @typedef {import("./records.js").ImageContents} ImageContents */
/** @typedef {import("./records.js").Outcome} Outcome */
/** @typedef {import("./records.js").Outline} Outline */
/** @typedef {import("./records.js").Point} Point */
/** @typedef {import("./records.js").Prediction} Prediction */
/** @typedef {import("./records.js").Reversal} Reversal */
/** @typedef {import("./records.js").Status} Status */
/** @typedef {import("./records.js").Way} Way */
/** @typedef {import("./records.js").Whole} Whole */

/**
 * @typedef {Object} Welcome
 * @property {"welcome"} type
 * @property {string} user
 * @property {string} project
 * @property {boolean} look_ahead
 */

/**
 * @typedef {Object} Show
 * @property {"show"} type
 * @property {ImageContents} contents
 * @property {string} photo
 * @property {string | null} select
 * @property {number} position
 * @property {number} count
 * @property {string[]} ahead
 */

/**
 * @typedef {Object} Outcomes
 * @property {"outcomes"} type
 * @property {Outcome[]} outcomes
 */

/**
 * @typedef {Object} Working
 * @property {"working"} type
 */

/**
 * @typedef {Object} StatusChanged
 * @property {"status"} type
 * @property {number} image
 * @property {Status} status
 * @property {string} user
 */

/**
 * @typedef {Object} Recalled
 * @property {"recalled"} type
 * @property {number} image
 * @property {Way} way
 * @property {number | null} change_set
 * @property {Reversal | null} reversal
 */

/**
 * @typedef {Object} Changed
 * @property {"changed"} type
 * @property {number} image
 * @property {Annotation[]} annotations
 * @property {string} user
 */

/**
 * @typedef {Object} Predicted
 * @property {"predicted"} type
 * @property {number} image
 * @property {Prediction[]} predictions
 */

/**
 * @typedef {Object} ComparedCap
 * @property {string | null} annotation
 * @property {Prediction | null} prediction
 * @property {number | null} iou
 * @property {number | null} cdr
 * @property {number | null} floor
 */

/**
 * @typedef {Object} Compared
 * @property {"compared"} type
 * @property {number} image
 * @property {ComparedCap[]} caps
 * @property {Annotation[]} turned_down
 * @property {string | null} second
 */

/**
 * @typedef {Object} MarkAgain
 * @property {"mark_again"} type
 * @property {string} annotation
 * @property {string} photo
 * @property {number} width
 * @property {[number, number, number, number]} box
 * @property {Point} at
 * @property {boolean} mirrored
 * @property {"circle" | "polygon"} mark
 * @property {number} left
 */

/**
 * @typedef {Object} KeptAgain
 * @property {"kept_again"} type
 * @property {string} id
 */

/**
 * @typedef {Object} FoundCap
 * @property {"found_cap"} type
 * @property {number} seq
 * @property {number} image
 * @property {Outline | null} visible
 * @property {number | null} score
 */

/**
 * @typedef {Object} Arc
 * @property {"visible" | "hidden" | "border" | "contact" | "concave"} kind
 * @property {number[]} points
 * @property {boolean} told
 */

/**
 * @typedef {Object} Fit
 * @property {Whole | null} whole
 * @property {Point | null} centre
 * @property {Point | null} centre_sd
 * @property {string | null} refusal
 */

/**
 * @typedef {Object} Fitted
 * @property {"fit"} type
 * @property {number} seq
 * @property {string} annotation
 * @property {Fit} fit
 * @property {Arc[]} arcs
 * @property {string} note
 * @property {"circle" | "polygon" | null} mark
 */

/**
 * @typedef {Object} JobProgress
 * @property {"progress"} type
 * @property {number} job
 * @property {number} done
 * @property {number} total
 * @property {string} words
 */

/**
 * @typedef {Object} Command
 * @property {"command"} type
 * @property {string} name
 */

/**
 * @typedef {Object} Notice
 * @property {"notice"} type
 * @property {string} text
 * @property {"info" | "warning" | "error"} level
 * @property {number | null} undo
 */

/** @typedef {Welcome | Show | Outcomes | Working | StatusChanged | Recalled | Changed | Predicted | FoundCap | Compared | MarkAgain | KeptAgain | Fitted | JobProgress | Command | Notice} FromServer */

export {};
