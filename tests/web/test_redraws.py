"""What is drawn again while somebody works in the annotator: only what shows something else than before."""

from __future__ import annotations

import logging

import pytest

pytestmark = [pytest.mark.browser, pytest.mark.timeout(120)]

MOVES = 60
STEPS = 12

# React tells this hook of every commit, in the built app too; a fiber with the flag 1 was called in that commit. The
# built app has no names of components, so one is counted under the nearest label around it: a group, a tool, a row.
HOOK = """() => {
  const log = { commits: 0, components: 0, renders: {} };
  window.redraws = log;
  const count = (fiber, place) => {
    for (let child = fiber; child; child = child.sibling) {
      const isHost = typeof child.type === 'string';
      const label = isHost && (child.pendingProps['aria-label'] || child.pendingProps['data-testid']);
      const here = label ? String(label).replace(/ of frame.*/, '') : place;
      const before = child.alternate;
      const isComponent = ['function', 'object'].includes(typeof child.type) && child.type !== null;
      if (isComponent && (before === null || (child.flags & 1) !== 0)) {
        log.components += 1;
        log.renders[here] = (log.renders[here] || 0) + 1;
      }
      if (before === null || child.child !== before.child) count(child.child, here);
    }
  };
  window.__REACT_DEVTOOLS_GLOBAL_HOOK__ = {
    isDisabled: false, supportsFiber: true, renderers: new Map(),
    inject: () => 1, onCommitFiberUnmount: () => {}, onPostCommitFiberRoot: () => {}, checkDCE: () => {},
    onCommitFiberRoot: (id, root) => {
      log.commits += 1;
      count(root.current.child, root.containerInfo?.id === 'root' ? 'page' : 'picture');
    },
  };
}"""

FORGET = "() => Object.assign(window.redraws, { commits: 0, components: 0, renders: {} })"

# Moves one joint by one pixel a frame of the screen, as a hand with a mouse does. The first move, with which saving and
# tools learn that something is dragged, is not counted.
DRAG = """([x, y, moves]) => new Promise((resolve) => {
  const pane = document.querySelector('[data-picture]');
  const send = (type, by) => pane.dispatchEvent(new PointerEvent(type, {
    bubbles: true, cancelable: true, pointerId: 1, pointerType: 'mouse', isPrimary: true,
    button: type === 'pointermove' ? -1 : 0, buttons: 1, clientX: x + by, clientY: y + by / 2 }));
  pane.setPointerCapture = () => {};
  send('pointerdown', 0);
  send('pointermove', 10);
  let made = 0;
  let spent = 0;
  const next = () => requestAnimationFrame(() => setTimeout(move));
  const move = () => {
    if (made === 0) Object.assign(window.redraws, { commits: 0, components: 0, renders: {} });
    if (made === moves) {
      const counted = structuredClone(window.redraws);
      delete pane.setPointerCapture;
      send('pointerup', 10 + moves);
      return resolve({ ...counted, spent });
    }
    made += 1;
    const begin = performance.now();
    send('pointermove', 10 + made);
    queueMicrotask(() => { spent += performance.now() - begin; next(); });
  };
  next();
})"""

# From the key to the picture of the next frame on its canvas.
STEP = """(steps) => new Promise((resolve) => {
  const pane = document.querySelector('[data-picture]');
  const times = [];
  let begin = 0;
  const press = () => {
    begin = performance.now();
    const key = { key: 'f', code: 'KeyF', bubbles: true, cancelable: true };
    document.activeElement.dispatchEvent(new KeyboardEvent('keydown', key));
  };
  const observer = new MutationObserver(() => {
    if (pane.dataset.drawn !== pane.dataset.frame) return;
    times.push(performance.now() - begin);
    if (times.length === steps) { observer.disconnect(); resolve(times); } else setTimeout(press, 100);
  });
  observer.observe(pane, { attributes: true, attributeFilter: ['data-drawn'] });
  press();
})"""


@pytest.mark.slow
def test_a_drag_draws_the_hand_and_nothing_around_it(recording, synthesized, open_page, picture_of, record_property):
    page = open_page()
    page.add_init_script(f"({HOOK})()")
    page.goto(f"/recordings/{recording['id']}/annotate?frame=0&hand=right")
    picture = picture_of(page)
    picture.wait()
    for x, y in synthesized.joints:
        picture.click(x, y)
    picture.wait_until_saved()
    page.wait_for_load_state("networkidle")

    drag = page.evaluate(DRAG, [*picture.at(*synthesized.joints[8]), MOVES])
    picture.wait_until_saved()
    page.evaluate(FORGET)
    times = sorted(page.evaluate(STEP, STEPS))
    steps = page.evaluate("window.redraws")
    report = (
        f"a drag of {MOVES} moves: {drag['commits']} commits, {drag['components']} components, {drag['spent']:.0f} ms; "
        f"{STEPS} steps: {steps['commits']} commits, {steps['components']} components, "
        f"{times[len(times) // 2]:.1f} ms at the median and {times[-1]:.1f} ms at most from the key to the picture"
    )
    record_property("redraws", report)
    logging.getLogger(__name__).info(report)
    around = {place: count for place, count in drag["renders"].items() if place != "picture"}
    assert around.pop("page", 0) <= MOVES, "the status line says where the pointer is, once a move"
    assert not around, "panels, tools and timeline show the same as before, so they are not drawn again"
    assert drag["commits"] <= 2 * MOVES, "one commit for the hand, one for the pointer's place"
    assert drag["components"] <= 20 * MOVES, "of the hand: the joint that moves, its bones, the cursor"
    assert steps["components"] <= 200 * STEPS, "a step draws what tells of the frame, not the whole page"
