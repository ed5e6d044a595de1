/**
 * What a person can do by key or button, and the layers of the picture: names, words and keys, once for
 * the keyboard, the key list and the panel. What a command does stands in `input/actions.js`.
 *
 * `words` are for the key list, `label` is for a button where that has other words, `hint` is shown while a tool is in hand. A key is written as the
 * key list shows it; `second` is what stands where a second annotator's caps are compared, with `{}` for what theirs are called. From its first brace on this is JSON: `app/editor_commands.py` reads it too.
 *
 * @module
 */

export default {
  "groups": [
    {
      "title": "Tools",
      "commands": [
        {
          "name": "select",
          "keys": ["V"],
          "words": "Select and edit",
          "label": "Select",
          "hint": "Drag a vertex, an edge or the cap · Ctrl-drag redraws a rim · Shift-drag selects"
        },
        {
          "name": "point",
          "keys": ["E"],
          "words": "Take the cap that the network sees under the pointer",
          "label": "Point",
          "hint": "Click takes the cap that is shown · Shift-click adds, Alt-click takes away · drag a box"
        },
        {
          "name": "polygon",
          "keys": ["W"],
          "words": "Draw a visible outline",
          "label": "Outline",
          "hint": "Click points or draw freehand · Enter, a double click or the first point closes"
        },
        {
          "name": "circle",
          "keys": ["C"],
          "words": "Drag out a circle from its centre",
          "label": "Circle",
          "hint": "Drag from the centre outwards · T draws it to the rim"
        },
        {
          "name": "rim_points",
          "keys": ["O"],
          "words": "A circle by three points of its rim, an ellipse by five and more",
          "label": "Points",
          "hint": "Click points of the rim: three a circle, five an ellipse · Enter puts it down"
        },
        {
          "name": "rim",
          "keys": ["R"],
          "words": "Redraw a stretch of a rim, add to a cap, cut from it",
          "label": "Rim",
          "hint": "One stroke from rim to rim: outside adds, inside cuts · Alt takes the other side"
        },
        {
          "name": "split",
          "keys": ["K"],
          "words": "Make two caps of one with a stroke across it",
          "label": "Split",
          "hint": "One stroke across a cap, from rim to rim"
        },
        {
          "name": "arcs",
          "keys": ["L"],
          "words": "Say what pieces of a rim are: own, hidden, cut off, touching",
          "label": "Arcs",
          "hint": "Click a piece of the rim, or drag along it, to call it something else · Del: as worked out"
        },
        { "name": "part", "keys": ["Shift+W"], "words": "Draw another part of the selected cap" },
        {
          "name": "pan",
          "keys": ["G"],
          "words": "Move the view",
          "label": "Pan",
          "hint": "Drag moves the view · the wheel zooms"
        },
        { "name": "finish", "keys": ["Enter"], "words": "Close the outline being drawn, take the circle or ellipse" },
        { "name": "cancel", "keys": ["Esc"], "words": "Drop what is half done (Ctrl+Z brings it back), then deselect" },
        {
          "name": "delete",
          "keys": ["Del", "Backspace"],
          "words": "Delete the vertex under the pointer, else the cap, else what is selected",
          "label": "Delete"
        }
      ]
    },
    {
      "title": "Image",
      "commands": [
        { "name": "next_image", "keys": ["N", "PageDown"], "words": "Next image" },
        { "name": "previous_image", "keys": ["P", "PageUp"], "words": "Previous image" },
        { "name": "done", "keys": ["Ctrl+Enter"], "words": "Mark as annotated and go to the next", "label": "Done" },
        { "name": "to_do", "keys": [], "words": "Set the status to “to do”", "label": "To do" },
        { "name": "annotated", "keys": [], "words": "Set the status to “annotated”", "label": "Annotated" },
        { "name": "approved", "keys": [], "words": "Set the status to “approved”", "label": "Approved" },
        { "name": "fit", "keys": ["F"], "words": "Fit the photo", "label": "Fit" },
        { "name": "zoom_selection", "keys": ["Z"], "words": "Zoom to the selection" },
        { "name": "zoom_in", "keys": ["+", "="], "words": "Zoom in" },
        { "name": "zoom_out", "keys": ["-"], "words": "Zoom out" },
        { "name": "loupe", "keys": ["Q"], "words": "A loupe at the pointer, or none" },
        { "name": "plain_photo", "keys": [], "words": "Show the photo as it is", "label": "Photo as it is" },
        { "name": "tour", "keys": [], "words": "Try out the tools in a minute", "label": "Take the tour (1 min)" },
        { "name": "switch_focus", "keys": ["F6"], "words": "From the photo to the panel and back" },
        { "name": "help", "keys": ["F1", "?"], "words": "This list", "label": "Keys" }
      ]
    },
    {
      "title": "Caps",
      "commands": [
        { "name": "next_cap", "keys": ["Tab"], "words": "Next cap" },
        { "name": "previous_cap", "keys": ["Shift+Tab"], "words": "Previous cap" },
        { "name": "select_all", "keys": ["Ctrl+A"], "words": "Select all" },
        { "name": "accept", "keys": ["A"], "words": "Accept the selected prediction", "label": "Accept" },
        { "name": "check", "keys": ["Space"], "words": "This one is right: on to the next worst", "label": "Right" },
        { "name": "next_open", "keys": ["Shift+N"], "words": "Next open cap, row by row; decides nothing", "label": "Next open" },
        { "name": "accept_all", "keys": ["Shift+A"], "words": "Accept all open predictions from a score on", "label": "Accept all" },
        { "name": "tighten", "keys": ["T"], "words": "Draw the selected outlines to the rim nearby", "label": "Tighten" },
        { "name": "merge", "keys": ["J"], "words": "Make one cap of the selected ones", "label": "Merge" },
        { "name": "copy", "keys": ["Ctrl+C"], "words": "Copy the selected caps" },
        { "name": "paste", "keys": ["Ctrl+V"], "words": "Put them down at the pointer, on another photo at their places" },
        { "name": "paste_before", "keys": ["Shift+V"], "words": "Put down the caps of the photo shown before" },
        { "name": "mark", "keys": ["M"], "words": "Mark what has no mark: as the line below says, else its outline", "label": "Mark" },
        { "name": "unmark", "keys": ["Shift+M"], "words": "Take the mark away", "label": "Unmark" },
        { "name": "convert", "keys": ["X"], "words": "Circle to polygon mark and back, same centre" },
        { "name": "doubtful", "keys": ["D"], "words": "Doubtful: a careful person could disagree", "label": "Doubtful" },
        { "name": "ignored", "keys": ["I"], "words": "Ignored: counts neither way", "label": "Ignored" },
        { "name": "ignore_buds", "keys": ["Shift+I"], "words": "Ignore all caps smaller than 30 pixels" },
        { "name": "lower", "keys": ["[", "Alt+↓"], "words": "Lower in the overlap order" },
        { "name": "raise", "keys": ["]", "Alt+↑"], "words": "Higher in the overlap order" },
        { "name": "nudge_left", "keys": ["←"], "words": "Move by a quarter of a pixel" },
        { "name": "nudge_right", "keys": ["→"], "words": "Move by a quarter of a pixel" },
        { "name": "nudge_up", "keys": ["↑"], "words": "Move by a quarter of a pixel" },
        { "name": "nudge_down", "keys": ["↓"], "words": "Move by a quarter of a pixel" },
        { "name": "push_left", "keys": ["Shift+←"], "words": "Move by a pixel" },
        { "name": "push_right", "keys": ["Shift+→"], "words": "Move by a pixel" },
        { "name": "push_up", "keys": ["Shift+↑"], "words": "Move by a pixel" },
        { "name": "push_down", "keys": ["Shift+↓"], "words": "Move by a pixel" },
        { "name": "undo", "keys": ["Ctrl+Z"], "words": "Undo; while drawing, the last point", "label": "Undo" },
        { "name": "redo", "keys": ["Ctrl+Shift+Z", "Ctrl+Y"], "words": "Redo", "label": "Redo" }
      ]
    },
    {
      "title": "Review",
      "commands": [
        { "name": "review", "keys": ["Shift+D"], "words": "Show what was drawn and what was predicted, or not", "label": "Both outlines", "second": { "words": "Show what was drawn and what {} has, or not", "label": "Both outlines" } },
        { "name": "next_difference", "keys": ["."], "words": "Next cap that differs, the worst first", "label": "Next" },
        { "name": "previous_difference", "keys": [","], "words": "Previous cap that differs", "label": "Previous" },
        { "name": "take_models", "keys": ["S"], "words": "Take the model’s (second annotator’s): its outline, its cap, or no cap", "label": "Model’s", "second": { "words": "Take the second annotator’s, {}: the outline with its mark, the cap, or no cap", "label": "Second’s" } },
        { "name": "take_annotators", "keys": ["U"], "words": "Take the annotator’s: approve the cap", "label": "Annotator’s", "second": { "words": "Take the first annotator’s: approve the cap, turn down what {} alone has", "label": "First’s" } },
        { "name": "approve", "keys": ["Shift+Enter"], "words": "Approve the image and go to the next", "label": "Approve" },
        { "name": "send_back", "keys": ["Shift+R"], "words": "Send it back with a comment", "label": "Send back" },
        { "name": "reject", "keys": ["Shift+X"], "words": "Reject it with a reason", "label": "Reject" },
        { "name": "comment", "keys": ["Shift+C"], "words": "Comment on the selected cap or the image", "label": "Comment" },
        { "name": "mark_again", "keys": ["Shift+O"], "words": "Mark caps again that you are asked for", "label": "Mark again" },
        { "name": "magnify", "keys": ["Y"], "words": "Errors of centres ten times as long, or as they are", "label": "Errors × 10" },
        { "name": "blink", "keys": ["Shift+L"], "words": "Drawn and predicted outlines in turn, or both", "label": "Blink", "second": { "words": "What was drawn and what {} has in turn, or both", "label": "Blink" } }
      ]
    }
  ],
  "layers": [
    { "name": "photo", "key": "1", "words": "Photo", "shown": true },
    { "name": "outline", "key": "2", "words": "Visible outlines", "shown": true },
    { "name": "fill", "key": "3", "words": "Filled masks", "shown": true },
    { "name": "whole", "key": "4", "words": "Whole outlines", "shown": true },
    { "name": "centre", "key": "5", "words": "Centres", "shown": true },
    { "name": "label", "key": "6", "words": "Labels", "shown": false },
    { "name": "prediction", "key": "7", "words": "Predictions", "shown": true },
    { "name": "uncertainty", "key": "8", "words": "Uncertainty of centres", "shown": false },
    { "name": "checked", "key": "9", "words": "Checked caps, not only faintly", "shown": true }
  ],
  "held": [
    { "name": "pan", "key": "Space", "words": "A drag moves the view" },
    { "name": "hide", "key": "H", "words": "Hide all shapes" },
    { "name": "broom", "key": "B", "words": "Broom: delete the caps that the pointer runs over",
      "hint": "Run over caps: they go when the key is let go · Esc lets them be" }
  ],
  "gestures": [
    { "gesture": "Wheel", "words": "Zoom to the pointer" },
    { "gesture": "Drag the ground · middle or right drag", "words": "Move the view" },
    { "gesture": "Click · again", "words": "Select · what lies under it" },
    { "gesture": "Shift-click", "words": "Add to the selection, or take from it" },
    { "gesture": "Shift-drag to the right · to the left", "words": "Select all inside · all that is touched" },
    { "gesture": "Double click", "words": "Zoom to the cap" },
    { "gesture": "Drag a vertex", "words": "Move it; a dense outline follows (Alt: this vertex only)" },
    { "gesture": "Point: click · Shift-click · Alt-click · drag", "words": "Take · add · take away · the cap in a box" },
    { "gesture": "Drag an edge", "words": "Put a vertex in" },
    { "gesture": "Alt-click a vertex", "words": "Take it out" },
    { "gesture": "Ctrl-drag along a rim", "words": "Redraw that stretch (Alt: the other side)" }
  ]
};
