/**
 * What is stored: images, caps, predictions, edits and what becomes of them; the JSON of `storage/records.py`.
 *
 * @module
 */

/** @typedef {[number, number]} Point  x right, y down, the centre of pixel i at i + 0.5 */

/** @typedef {number[][]} Outline  parts, each a flat list x0, y0, x1, y1, … */

/** @typedef {Circle | Ellipse} Whole */

/** @typedef {Circle | Ellipse | Polygon} Mark */

/** @typedef {"new" | "annotated" | "approved"} Status */

/**
 * @typedef {Object} Circle
 * @property {"circle"} kind
 * @property {number} cx
 * @property {number} cy
 * @property {number} r
 */

/**
 * @typedef {Object} Ellipse
 * @property {"ellipse"} kind
 * @property {number} cx
 * @property {number} cy
 * @property {number} a
 * @property {number} b
 * @property {number} theta_deg
 */

/**
 * @typedef {Object} Polygon
 * @property {"polygon"} kind
 * @property {number[]} points
 */

/**
 * @typedef {Object} Image
 * @property {number} id
 * @property {string} file_name
 * @property {string} path
 * @property {number} width
 * @property {number} height
 * @property {string} sha256
 * @property {string | null} light
 * @property {string | null} form
 * @property {string | null} split
 * @property {Status} status
 * @property {Record<string, number> | null} statistics
 * @property {Record<string, unknown>} extra
 */

/**
 * @typedef {Object} ToldArc
 * @property {"visible" | "hidden" | "border" | "contact"} kind
 * @property {number[]} points
 */

/**
 * @typedef {Object} Cap
 * @property {Outline} visible
 * @property {Mark | null} mark
 * @property {boolean} ignored
 * @property {boolean} doubtful
 * @property {number | null} order
 * @property {string} category
 * @property {number | null} prediction
 * @property {ToldArc[]} [arcs]
 */

/**
 * @typedef {Object} Annotation
 * @property {string} uid
 * @property {number} image
 * @property {number} revision
 * @property {Cap} cap
 * @property {boolean} deleted
 * @property {Whole | null} whole
 * @property {Point | null} centre
 * @property {Point | null} centre_sd
 * @property {Record<string, unknown>} extra
 */

/**
 * @typedef {Object} Prediction
 * @property {number} id
 * @property {number} run
 * @property {number} image
 * @property {Outline} visible
 * @property {number} score
 * @property {number | null} quality
 * @property {string} category
 * @property {Whole | null} whole
 * @property {Point | null} centre
 * @property {Record<string, unknown>} extra
 */

/**
 * @typedef {Object} Run
 * @property {number} id
 * @property {string} name
 * @property {"import" | "simulated" | "network" | "second"} kind
 * @property {string} made_at
 * @property {string | null} weights
 * @property {Record<string, unknown>} settings
 */

/**
 * @typedef {Object} Edit
 * @property {string} id
 * @property {string} annotation
 * @property {number} image
 * @property {number} base
 * @property {Cap | null} cap
 * @property {string} change_set
 * @property {string} takes_back
 */

/**
 * @typedef {Object} StatusEdit
 * @property {string} id
 * @property {number} image
 * @property {Status} before
 * @property {Status} after
 * @property {string} change_set
 * @property {string} takes_back
 */

/** @typedef {"approved" | "rejected" | "sent_back" | "comment" | "withdrawn"} Says */

/**
 * @typedef {Object} Verdict
 * @property {string} id
 * @property {number} image
 * @property {string | null} annotation
 * @property {Says} says
 * @property {string} words
 * @property {string} change_set
 */

/**
 * @typedef {Object} Accepted
 * @property {"accepted"} outcome
 * @property {string} edit
 * @property {Annotation} annotation
 */

/**
 * @typedef {Object} Conflict
 * @property {"conflict"} outcome
 * @property {string} edit
 * @property {Annotation} theirs
 * @property {string} user
 */

/**
 * @typedef {Object} Refused
 * @property {"refused"} outcome
 * @property {string} edit
 * @property {string} reason
 */

/**
 * @typedef {Object} StatusStored
 * @property {"status"} outcome
 * @property {string} edit
 * @property {number} image
 * @property {Status} status
 */

/** @typedef {Accepted | Conflict | Refused | StatusStored} Outcome */

/** @typedef {"undo" | "redo"} Way */

/**
 * @typedef {Object} Return
 * @property {Annotation} annotation
 * @property {Cap | null} cap
 * @property {boolean} deleted
 */

/**
 * @typedef {Object} VerdictToWithdraw
 * @property {string | null} annotation
 * @property {Says} says
 * @property {string} words
 */

/**
 * @typedef {Object} Reversal
 * @property {string} id
 * @property {string} made_at
 * @property {Return[]} returns
 * @property {number} changed_since
 * @property {[Status, Status] | null} status
 * @property {VerdictToWithdraw | null} verdict
 */

/**
 * @typedef {Object} ImageContents
 * @property {Image} image
 * @property {Annotation[]} annotations
 * @property {Prediction[]} predictions
 * @property {Run | null} run
 * @property {string[]} unchecked
 * @property {unknown[]} [likely]
 */

export {};
