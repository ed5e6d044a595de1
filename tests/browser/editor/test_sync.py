"""Store, history and outbox against a server that loses connections: both sides end up the same."""

from __future__ import annotations

import pytest

WORLD = """
  const {Store} = await import('/editor/state/store.js');
  const {Outbox} = await import('/editor/sync/outbox.js');
  const {newCap} = await import('/editor/geometry/caps.js');
  const {changed} = await import('/editor/geometry/shapes.js');

  /** The journal as the server keeps it. */
  const journal = new Map(), seen = new Map();
  const clone = (value) => JSON.parse(JSON.stringify(value));
  function commitOne(edit) {
    if (seen.has(edit.id)) return seen.get(edit.id);
    const now = journal.get(edit.annotation);
    if ((now?.revision ?? 0) !== edit.base)
      return {outcome: 'conflict', edit: edit.id, theirs: now, user: 'Bob'};
    const annotation = {uid: edit.annotation, image: edit.image, revision: edit.base + 1,
      cap: edit.cap ?? now.cap, deleted: edit.cap === null, whole: null, centre: null, extra: {}};
    journal.set(edit.annotation, annotation);
    seen.set(edit.id, {outcome: 'accepted', edit: edit.id, annotation});
    return seen.get(edit.id);
  }
  const bob = (uid, cap) =>
    commitOne({id: `bob${seen.size}`, annotation: uid, image: 1, base: journal.get(uid).revision, cap});

  const wire = {up: true, sent: [], refused: []};
  const store = new Store();
  const sync = new m.Sync({store, progress() {}, stalled() {}, refused: (reason) => wire.refused.push(reason),
    send: (message) => wire.up && wire.sent.push(clone(message)) > 0});
  localStorage.clear();
  sync.use(new Outbox(localStorage, 'p:'));
  /** The server reads one message; the answer may get lost on its way. */
  function serve(answer = true) {
    const message = wire.sent.shift();
    if (!message) return false;
    const outcomes = clone(message.edits.map(commitOne));
    if (answer) sync.settle(outcomes);
    return true;
  }
  const drain = () => { for (let i = 0; i < 500 && serve(); i++); };
  const reconnect = () => { wire.sent.length = 0; wire.up = true; sync.pause(); show(); sync.resume(); };
  const show = () => sync.open(1, clone([...journal.values()].filter(({deleted}) => !deleted)));
  show();
  const triangle = (x) => [[x, 0, x + 9, 0, x, 9]];
  const shape = (uid, x) => ({uid, cap: newCap({visible: triangle(x)}), revision: 0, deleted: false,
    whole: null, centre: null, score: null});
  const create = (uid, x = 0) => sync.commit([{before: null, after: shape(uid, x)}]);
  const become = (uid, fields) => sync.commit([changed(store.get(uid), {...store.get(uid), ...fields})]);
  const move = (uid, x) => become(uid, {cap: {...store.get(uid).cap, visible: triangle(x)}});
  const remove = (uid) => become(uid, {deleted: true});
  const capsOf = (shapes) => Object.fromEntries(shapes.map(({uid, cap}) => [uid, cap]).sort());
  const here = () => capsOf(store.live());
  const there = () => capsOf([...journal.values()].filter(({deleted}) => !deleted));
  /** The same numbers below n for the same seed. */
  const chances = (state) => (n) => {
    state = (state * 1103515245 + 12345) % 2147483648;
    return Math.floor(state / 65536) % n;
  };
  const same = () => JSON.stringify(here()) === JSON.stringify(there());
"""


@pytest.mark.parametrize("seed", range(12))
def test_any_sequence_of_edits_undos_and_broken_connections_ends_with_both_sides_the_same(
    call, seed: int
) -> None:
    body = (
        WORLD
        + """
      const chance = chances(a * 7919 + 1);
      for (let i = 0; i < 150; i++) {
        const live = store.live();
        const one = live[chance(Math.max(live.length, 1))];
        const what = chance(12);
        if (what < 3 || !one) create(`c${i}`, i);
        else if (what < 6) move(one.uid, i);
        else if (what === 6) remove(one.uid);
        else if (what === 7) sync.undo();
        else if (what === 8) sync.redo();
        else if (what === 9) serve();
        else if (what === 10) serve(false), wire.up = false, sync.pause();
        else reconnect();
      }
      reconnect(); drain();
      return [sync.waiting, same(), Object.keys(here()).length, sync.clashes.length, wire.refused];
    """
    )
    waiting, same, count, clashes, refused = call("sync/sync", body, seed)
    assert (waiting, same, clashes, refused) == (0, True, 0, [])
    assert count > 3


@pytest.mark.parametrize("seed", range(6))
def test_undoing_everything_leads_back_and_redoing_everything_forth(call, seed: int) -> None:
    body = (
        WORLD
        + """
      const chance = chances(a * 104729 + 3);
      const past = [JSON.stringify(here())];
      for (let i = 0; i < 60; i++) {
        const live = store.live();
        const one = live[chance(Math.max(live.length, 1))];
        const what = chance(4);
        if (what < 2 || !one) create(`c${i}`, i);
        else if (what === 2) move(one.uid, i);
        else remove(one.uid);
        past.push(JSON.stringify(here()));
      }
      const wrong = [];
      const compare = (i) => {
        if (chance(3) === 0) drain();
        if (JSON.stringify(here()) !== past[i]) wrong.push(i);
      };
      for (let i = 59; i >= 0; i--) sync.undo(), compare(i);
      const dry = sync.undo();
      for (let i = 1; i <= 60; i++) sync.redo(), compare(i);
      drain();
      return [wrong, dry, sync.redo(), same(), sync.clashes.length];
    """
    )
    assert call("sync/sync", body, seed) == [[], None, None, True, 0]


def test_an_edit_is_acknowledged_once_however_often_it_is_sent(call) -> None:
    body = (
        WORLD
        + """
      create('u'); serve(false); reconnect(); drain();
      return [journal.get('u').revision, sync.waiting, same()];
    """
    )
    assert call("sync/sync", body) == [1, 0, True]


def test_a_lost_update_becomes_a_conflict_and_nothing_is_overwritten(call) -> None:
    body = (
        WORLD
        + """
      create('u', 1); drain();
      bob('u', {...journal.get('u').cap, doubtful: true});
      move('u', 50); move('u', 60); drain();
      const kept = journal.get('u').cap.doubtful;
      const clashes = sync.clashes.map(({uid, user}) => [uid, user]);
      return [kept, clashes, store.get('u').cap.visible[0][0], sync.waiting];
    """
    )
    assert call("sync/sync", body) == [True, [["u", "Bob"]], 60, 0]


@pytest.mark.parametrize(("whose", "x", "doubtful"), [("mine", 70, False), ("theirs", 1, True)])
def test_a_conflict_ends_with_the_side_that_was_chosen(call, whose: str, x: int, doubtful: bool) -> None:
    body = (
        WORLD
        + """
      create('u', 1); drain();
      bob('u', {...journal.get('u').cap, doubtful: true});
      move('u', 50); drain();
      move('u', 70);
      sync.resolve(sync.clashes[0], a); drain();
      return [journal.get('u').cap.visible[0][0], journal.get('u').cap.doubtful, same(), sync.clashes.length];
    """
    )
    assert call("sync/sync", body, whose) == [x, doubtful, True, 0]


def test_a_conflict_not_settled_comes_back_after_a_reload(call) -> None:
    body = (
        WORLD
        + """
      create('u', 1); drain();
      bob('u', {...journal.get('u').cap, doubtful: true});
      move('u', 50); drain(); move('u', 55);
      const send = (message) => wire.sent.push(clone(message)) > 0;
      const again = new m.Sync({store, send, progress() {}, stalled() {}, refused() {}});
      again.use(new Outbox(localStorage, 'p:'));
      again.open(1, clone([...journal.values()]));
      again.resume();
      again.settle(clone(wire.sent.shift().edits.map(commitOne)));
      return [again.clashes.length, store.get('u').cap.visible[0][0], journal.get('u').cap.doubtful];
    """
    )
    assert call("sync/sync", body) == [1, 55, True]


def test_a_refused_edit_gives_way_to_what_is_stored_and_says_why(call) -> None:
    body = (
        WORLD
        + """
      create('u', 1); drain(); move('u', 50); move('u', 60);
      const {edits} = wire.sent.shift();
      sync.settle([{outcome: 'refused', edit: edits[0].id, reason: 'Too far out.'}]);
      return [store.get('u').cap.visible[0][0], sync.waiting, wire.refused, same()];
    """
    )
    assert call("sync/sync", body) == [1, 0, ["Too far out."], True]


def test_undo_leaves_a_cap_alone_that_somebody_else_has_changed_since(call) -> None:
    body = (
        WORLD
        + """
      create('u', 1); create('v', 2); drain(); move('u', 50); drain();
      bob('u', {...journal.get('u').cap, doubtful: true});
      sync.changed(1, clone([journal.get('u')]));
      sync.undo(); drain();
      const {doubtful, visible} = store.get('u').cap;
      return [doubtful, visible[0][0], store.live().map(({uid}) => uid)];
    """
    )
    assert call("sync/sync", body) == [True, 50, ["u"]]


def test_undoing_an_accepted_or_rejected_prediction_sets_the_prediction_free(call) -> None:
    body = (
        WORLD
        + """
      const predicted = {...shape('prediction:7', 3), score: 0.9}; predicted.cap.prediction = 7;
      const claims = () => [...journal.values()].map(({cap, deleted}) => [cap.prediction, deleted]);
      sync.commit([changed(predicted, predicted)]); drain();
      const accepted = claims(); sync.undo(); drain();
      const undone = claims(); journal.clear();
      sync.commit([changed(predicted, {...predicted, deleted: true})]); drain();
      const rejected = claims(); sync.undo(); drain();
      return [accepted, undone, rejected, claims()];
    """
    )
    assert call("sync/sync", body) == [[[7, False]], [[None, True]], [[7, True]], [[None, True]]]
