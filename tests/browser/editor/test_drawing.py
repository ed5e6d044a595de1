"""The canvases over the photo: one shown as a bitmap, one that is there only while it is drawn on."""

from __future__ import annotations

BITMAP = """
  const host = document.createElement('div');
  const drawing = new m.BitmapCanvas(host);
  const seen = (...where) => {
    const copy = new OffscreenCanvas(20, 10).getContext('2d');
    copy.drawImage(drawing.canvas, 0, 0);
    return where.map((x) => copy.getImageData(x, 4, 1, 1).data[0]);
  };
  const draw = (x) => {
    drawing.context.fillStyle = '#f00';
    drawing.context.fillRect(x, 0, 3, 5);
  };
  drawing.clear({width: 10, height: 5, ratio: 2});
"""


def test_a_drawing_is_on_the_screen_once_it_is_shown_and_keeps_what_was_drawn(call) -> None:
    body = """
      draw(0);
      drawing.show();
      const once = seen(5, 6, 12, 18);
      draw(6);
      drawing.show();
      return [once, seen(5, 6, 12, 18), drawing.canvas.style.width, drawing.canvas.style.height];
    """
    seen = call("render/bitmap_canvas", BITMAP + body)
    assert seen == [[255, 0, 0, 0], [255, 0, 255, 0], "10px", "5px"]


def test_the_screen_keeps_the_old_drawing_until_the_new_one_is_shown(call) -> None:
    body = """
      draw(0);
      drawing.show();
      drawing.clear({width: 10, height: 5, ratio: 2});
      const before = seen(5);
      drawing.show();
      return [before, seen(5)];
    """
    assert call("render/bitmap_canvas", BITMAP + body) == [[255], [0]]


def test_a_picture_drawn_elsewhere_is_shown_and_can_be_drawn_on(call) -> None:
    body = """
      const made = new OffscreenCanvas(20, 10);
      const put = () => {
        Object.assign(made.getContext('2d'), {fillStyle: '#f00'}).fillRect(0, 0, 6, 10);
        drawing.put(made.transferToImageBitmap(), {width: 10, height: 5, ratio: 2});
      };
      put();
      drawing.show();
      const shown = seen(5, 12);
      draw(6);
      drawing.show();
      const after = seen(5, 12);
      put();
      draw(6);
      drawing.show();
      return [shown, after, seen(5, 12)];
    """
    assert call("render/bitmap_canvas", BITMAP + body) == [[255, 0], [255, 255], [255, 255]]


def test_a_small_canvas_is_there_only_while_something_is_drawn_on_it(call) -> None:
    body = """
      const host = document.createElement('div');
      const canvas = new m.SmallCanvas(host);
      const turn = (bounds, something) => {
        canvas.draw(bounds, {width: 300, height: 200}, 1, () => something);
        return !host.firstChild.hidden;
      };
      const here = {x0: 10, y0: 10, x1: 50, y1: 50};
      return [turn(here, false), turn(here, true), turn(here, false), turn(here, true), turn(null, true)];
    """
    assert call("render/small_canvas", body) == [False, True, False, True, False]


def test_a_small_canvas_starts_empty_each_time_also_where_it_stays(call) -> None:
    body = """
      const host = document.createElement('div');
      const canvas = new m.SmallCanvas(host);
      const size = {width: 300, height: 200};
      const here = {x0: 10, y0: 10, x1: 50, y1: 50};
      const dot = (x) => canvas.draw(here, size, 1, (context) => {
        context.fillRect(x, 20, 4, 4);
        return true;
      });
      const seen = (...where) => where.map((x) => {
        const copy = new OffscreenCanvas(300, 200).getContext('2d');
        copy.drawImage(host.firstChild, 0, 0);
        return copy.getImageData(x, 21, 1, 1).data[3];
      });
      dot(20);
      const first = seen(21, 41);
      dot(40);
      return [first, seen(21, 41)];
    """
    assert call("render/small_canvas", body) == [[255, 0], [0, 255]]


POINTER = """
  const host = document.createElement('div');
  host.setPointerCapture = () => {};
  const dragged = [];
  const tool = {cursor: '', down() {}, up() {}, hover() {}, drag: ({screen}) => dragged.push(screen[0])};
  const { EditorState } = await import('/editor/state/editor_state.js');
  const pointer = new m.Pointer(host, new EditorState(() => {}), { tool: () => tool, caused() {} });
  const tell = (kind, clientX, wait = 0) => new Promise((resolve) => setTimeout(() => {
    host.dispatchEvent(new PointerEvent(kind, {clientX, button: 0, buttons: 1}));
    resolve();
  }, wait));
"""


def test_a_drag_follows_the_pointer_before_the_frame_does_and_only_once(call) -> None:
    body = (
        POINTER
        + """
      await tell('pointerrawupdate', 5, 10);
      await tell('pointerdown', 10);
      await tell('pointerrawupdate', 11, 10);
      await tell('pointermove', 11);
      await tell('pointermove', 12);
      await tell('pointerup', 12);
      await tell('pointerrawupdate', 13, 10);
      return dragged;
    """
    )
    assert call("input/pointer", body) == [11, 12]


def test_a_quick_mouse_is_followed_no_oftener_than_it_helps_but_to_where_it_ends(call) -> None:
    body = (
        POINTER
        + """
      await tell('pointerdown', 10);
      const start = performance.now();
      for (let x = 11; x < 200; x++) host.dispatchEvent(new PointerEvent('pointerrawupdate', {clientX: x}));
      const most = 1 + Math.ceil((performance.now() - start) / 4);
      host.dispatchEvent(new PointerEvent('pointermove', {clientX: 199}));
      return [dragged.length <= most + 1, dragged.at(-1)];
    """
    )
    assert call("input/pointer", body) == [True, 199]


def test_checked_caps_are_faint_outlines_where_only_open_ones_are_to_stand_out(call) -> None:
    body = """
      const visible = {outline: true, fill: true, prediction: true, checked: a};
      const cap = {visible: [[10, 10, 50, 10, 50, 50, 10, 50]], mark: null, ignored: false, doubtful: false};
      const seen = (checked) => {
        const context = new OffscreenCanvas(60, 60).getContext('2d');
        const shapes = [{uid: 'u', cap, checked, score: null, whole: null, centre: null}];
        m.paint(context, {scale: 1, x: 0, y: 0}, {x0: 0, y0: 0, x1: 60, y1: 60}, {
          shapes, visible, selected: new Set(), crowd: 1,
        });
        return [[30, 30], [30, 10]].map(([x, y]) => context.getImageData(x, y, 1, 1).data[3]);
      };
      return [seen(true), seen(false)];
    """
    full, open_ = call("render/paint", body, True)
    faint, still_open = call("render/paint", body, False)
    assert full[0] > 0
    assert full[1] > 200
    assert faint[0] == 0
    assert 0 < faint[1] < 120
    assert still_open[0] > open_[0]
    assert still_open[1] >= open_[1]
