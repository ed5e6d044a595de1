/**
 * What the editor and the server say to each other: the JSON of `app/protocol.py` and
 * `storage/records.py` as JSDoc types. A test compares the two.
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
 * @typedef {Object} Cap
 * @property {Outline} visible
 * @property {Mark | null} mark
 * @property {boolean} ignored
 * @property {boolean} doubtful
 * @property {number | null} order
 * @property {string} category
 * @property {number | null} prediction
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
 * @property {string} category
 * @property {Whole | null} whole
 * @property {Point | null} centre
 * @property {Record<string, unknown>} extra
 */

/**
 * @typedef {Object} Run
 * @property {number} id
 * @property {string} name
 * @property {"import" | "simulated" | "network"} kind
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
 * @typedef {Object} Reversal
 * @property {string} id
 * @property {string} made_at
 * @property {Return[]} returns
 * @property {number} changed_since
 * @property {[Status, Status] | null} status
 */

/**
 * @typedef {Object} ImageContents
 * @property {Image} image
 * @property {Annotation[]} annotations
 * @property {Prediction[]} predictions
 * @property {Run | null} run
 * @property {string[]} unchecked
 */

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

/** @typedef {Hello | Open | Step | Edits | Refit | Select | Recall | Saving | Window | Tag | Predict | Cancel | FindCap | Compare} ToServer */

/**
 * @typedef {Object} Welcome
 * @property {"welcome"} type
 * @property {string} user
 * @property {string} project
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
 * @property {"visible" | "hidden" | "border" | "concave"} kind
 * @property {number[]} points
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
 */

/** @typedef {Welcome | Show | Outcomes | Working | StatusChanged | Recalled | Changed | Predicted | FoundCap | Compared | Fitted | JobProgress | Command | Notice} FromServer */

export {};
