"""What lies over the photo: sheets shown as bitmaps, a glass that is there only while it is drawn on."""

from __future__ import annotations

SHEET = """
  const host = document.createElement('div');
  const sheet = new m.Sheet(host);
  const seen = (...where) => {
    const copy = new OffscreenCanvas(20, 10).getContext('2d');
    copy.drawImage(sheet.canvas, 0, 0);
    return where.map((x) => copy.getImageData(x, 4, 1, 1).data[0]);
  };
  const draw = (x) => {
    sheet.context.fillStyle = '#f00';
    sheet.context.fillRect(x, 0, 3, 5);
  };
"""


def test_a_sheet_is_on_the_screen_once_it_is_shown_and_keeps_what_was_drawn(call) -> None:
    body = (
        SHEET
        + """
      sheet.cut({width: 10, height: 5}, 2);
      draw(0);
      sheet.show();
      const once = seen(5, 6, 12, 18);
      draw(6);
      sheet.show();
      return [once, seen(5, 6, 12, 18), sheet.canvas.style.width, sheet.canvas.style.height];
    """
    )
    assert call("render/bitmap_canvas", body) == [[255, 0, 0, 0], [255, 0, 255, 0], "10px", "5px"]


def test_the_screen_keeps_the_old_sheet_until_the_new_one_is_shown(call) -> None:
    body = (
        SHEET
        + """
      sheet.cut({width: 10, height: 5}, 2);
      draw(0);
      sheet.show();
      sheet.cut({width: 10, height: 5}, 2);
      const before = seen(5);
      sheet.show();
      return [before, seen(5)];
    """
    )
    assert call("render/bitmap_canvas", body) == [[255], [0]]


def test_a_picture_drawn_elsewhere_is_shown_and_can_be_drawn_on(call) -> None:
    body = (
        SHEET
        + """
      const made = new OffscreenCanvas(20, 10);
      const put = () => {
        sheet.cut({width: 10, height: 5}, 2);
        Object.assign(made.getContext('2d'), {fillStyle: '#f00'}).fillRect(0, 0, 6, 10);
        sheet.put(made.transferToImageBitmap());
      };
      put();
      sheet.show();
      const shown = seen(5, 12);
      draw(6);
      sheet.show();
      const after = seen(5, 12);
      put();
      draw(6);
      sheet.show();
      return [shown, after, seen(5, 12)];
    """
    )
    assert call("render/bitmap_canvas", body) == [[255, 0], [255, 255], [255, 255]]


def test_a_glass_is_there_only_while_something_is_drawn_on_it(call) -> None:
    body = """
      const host = document.createElement('div');
      const glass = new m.Glass(host);
      const turn = (bounds, soils) => {
        glass.lay(bounds, {width: 300, height: 200}, 1);
        if (soils) glass.soil();
        glass.settle();
        return !host.firstChild.hidden;
      };
      const here = {x0: 10, y0: 10, x1: 50, y1: 50};
      return [turn(here, false), turn(here, true), turn(here, false), turn(here, true), turn(null, false)];
    """
    assert call("render/small_canvas", body) == [False, True, False, True, False]


POINTER = """
  const host = document.createElement('div');
  host.setPointerCapture = () => {};
  const dragged = [];
  const tool = {cursor: '', down() {}, up() {}, hover() {}, drag: ({screen}) => dragged.push(screen[0])};
  const desk = {lens: {view: {scale: 1, x: 0, y: 0}}, hover() {}};
  const pointer = new m.Pointer(host, desk, {blame() {}}, () => tool);
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
