// The picture of a live run in README.md: the hand pressed into the scene by the mouse. Usage: node live_picture.mjs PROGRAM CHROMIUM PNG
import { test } from "node:test";
import { limit, middle, openLive, all as png, startLive, until } from "./live_driver.mjs";

test("a live run, pressed for five seconds", limit, async () => {
  const live = await startLive("fig4.16"), { page } = await openLive(live.address);
  await page.setViewportSize({ width: 1180, height: 640 });
  const [x, y] = await middle(page), touches = async () =>
    until(page, (now) => now.contacts > 0 && now.force > 2, () => page.mouse.wheel(0, -100));
  await page.mouse.move(x, y);
  const { time } = await touches();
  await page.keyboard.press("2"); // from the side, then from higher up
  await page.mouse.down({ button: "right" });
  await page.mouse.move(x + 60, y + 70, { steps: 3 });
  await page.mouse.up({ button: "right" });
  await until(page, (now) => now.time > time + 5, () => page.waitForTimeout(100));
  await page.evaluate(() => { // all points, however slow the graphics are
    const { page: shown, scene, run } = window.remoteTouch;
    shown.pace.picture = () => false;
    shown.pace.share = 1;
    shown.paceNote.show(1);
    for (const cloud of scene.clouds) cloud.setShare(1);
    scene.show(run.ticks - 1);
  });
  // By software all points take seconds, and the banner then says that no tick has arrived.
  await page.screenshot({ path: png, style: ".banner { visibility: hidden }" });
  await live.stop();
});
