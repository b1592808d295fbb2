// A live run in a browser: the mouse as the hand, and what the page says of it. Usage: node live.mjs PROGRAM CHROMIUM [all]
// The experiments with a recording run only with all: each takes minutes with software graphics.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { test } from "node:test";
import { picture } from "./browser.mjs";
import { all, distance, dragMovesTheHand, limit, middle, newest, openLive, program, rests, startLive, until } from "./live_driver.mjs";

// The keys move the hand by what the page says.
async function stepsAreFineAndCoarse(page) {
  for (const [modifier, mm, text] of [["", 2, /^Step: 2 mm, 3° \(Shift: 0\.2 mm, 0\.3°; Alt: 10 mm, 15°\)$/],
    ["Shift", 0.2, /^Fine step: 0\.2 mm, 0\.3°$/], ["Alt", 10, /^Coarse step: 10 mm, 15°$/]]) {
    await rests(page);
    const before = (await newest(page)).hip, moved = (now) => 1000 * distance(now.hip, before);
    if (modifier) await page.keyboard.down(modifier);
    await page.keyboard.press("ArrowLeft");
    await page.waitForFunction((pattern) => new RegExp(pattern).test(document.querySelector("footer .steps").textContent), text.source);
    if (modifier) await page.keyboard.up(modifier);
    const after = await until(page, (now) => Math.abs(moved(now) - mm) < 0.02 * mm, async () => {});
    assert.ok(Math.abs(moved(after) - mm) < 0.02 * mm, `${modifier}: ${moved(after)} mm, expected ${mm} mm`);
  }
}

// With graphics that are slow, one of 32 points is drawn, and all within four contact radii of the hand.
async function pointsNearTheHandAreAllDrawn(page) {
  const { around, near, drawn, all } = await page.evaluate(() => {
    const { run, scene } = window.remoteTouch, tick = run.ticks - 1, frame = run.frameAt(), [cloud] = scene.clouds, before = cloud.share;
    cloud.setShare(1 / 32);
    scene.show(tick);
    const ends = [run.vector("hip_position", tick), run.vector("proxy_position", tick)], count = frame.positions.length / 3;
    const near = Array.from({ length: count }, (_, i) => run.point(frame, i)).filter((p) =>
      ends.some((end) => Math.hypot(...p.map((x, k) => x - end[k])) <= 4 * run.contactRadiusM)).length;
    const found = { around: cloud.nearHandCount, near, drawn: cloud.pointCount(), all: count };
    cloud.setShare(before);
    return found;
  });
  assert.ok(near > 50 && Math.abs(around - near) <= 2, `${around} of ${near} points near the hand are drawn`);
  assert.ok(drawn < all / 30, `${drawn} of ${all} of the others`);
}

async function touches(page) {
  const [x, y] = await middle(page);
  await page.keyboard.press("1");
  await page.mouse.move(x, y);
  return until(page, (now) => now.contacts > 0 && now.force > 0.3, async () => {
    for (let i = 0; i < 4; ++i) await page.mouse.wheel(0, -100);
  });
}

// Each slider to another place; what the run then has stands beside it.
async function changesParameters(page) {
  const rows = page.locator(".sliders label"), changed = [];
  for (const row of await rows.all()) {
    const input = row.locator("input"), before = await row.locator("output").textContent();
    if ((await input.getAttribute("type")) === "range") await input.fill("10");
    else await row.click();
    await page.waitForFunction(([name, old]) => [...document.querySelectorAll(".sliders label")].some((label) =>
      label.querySelector("span").textContent === name && label.querySelector("output").textContent !== old),
    [await row.locator("span").textContent(), before]);
    changed.push(`${await row.locator("span").textContent()}: ${before} -> ${await row.locator("output").textContent()}`);
  }
  assert.ok(changed.length > 0, "there are no sliders");
  assert.equal(await page.locator(".sliders .warning").isVisible(), false);
  return changed;
}

function digestOffline(session) {
  const out = execFileSync(program, ["-q", "--force", "run", session, "-o", "again.h5"], { encoding: "utf8" });
  return /digest ([0-9a-f]{64})/.exec(out)[1];
}

for (const name of ["fig4.16", ...(all ? ["fig5.8-recorded", "fig6.4-organ"] : [])])
  test(`${name}: the mouse touches, and the recording gives the same digest`, limit, async (t) => {
    if (!process.env.REMOTE_TOUCH_DATA && name !== "fig4.16") return t.skip("needs a recording below REMOTE_TOUCH_DATA");
    const { address, stop } = await startLive(name, "--record", `${name}.session.h5`, "--force");
    const { page, complaints } = await openLive(address);
    await dragMovesTheHand(page);
    await stepsAreFineAndCoarse(page);
    const touched = await touches(page);
    assert.ok(touched.contacts > 0 && touched.force > 0.3, `no contact: ${JSON.stringify(touched)}`);
    const shown = await picture(page);
    assert.ok(shown.drawn > 2000, "the picture is blank");
    if (name === "fig4.16") await pointsNearTheHandAreAllDrawn(page);
    console.log(`${name}: ${(await changesParameters(page)).join("; ")}`);
    const { uploads, draws, pictures, frames } = await page.evaluate(countWork);
    assert.equal(draws, pictures, "one picture, one draw of the points");
    assert.ok(uploads <= frames + 1, `${uploads} uploads of points for ${frames} frames`);
    console.log(`${name}: ${JSON.stringify({ ...touched, drawn: shown.drawn })}`);
    const { code, out } = await stop();
    assert.equal(code, 0, out);
    assert.deepEqual(complaints, []);
    await page.waitForSelector("body[data-state=ended]", { state: "attached" });
    assert.deepEqual(await page.locator(".banner p").allTextContents(), ["The run has ended: stopped by a signal. The picture is its last one."]);
    assert.ok(await page.evaluate(() => document.querySelector("fieldset.sliders").disabled), "nothing is left to set");
    assert.equal(digestOffline(`${name}.session.h5`), /digest of the trace: ([0-9a-f]{64})/.exec(out)[1]);
    await page.close();
  });

// Until three frames came and their points were uploaded three times: uploads, draws of all points, pictures and frames.
function countWork() {
  return new Promise((done) => {
    const { scene, page } = window.remoteTouch, gl = document.querySelector(".picture canvas").getContext("webgl2");
    const frames = window.remoteTouch.run.frameCount, all = window.remoteTouch.run.frameAt().positions.length / 3;
    let draws = 0, uploads = 0;
    const [drawArrays, bufferSubData] = [gl.drawArrays.bind(gl), gl.bufferSubData.bind(gl)];
    gl.drawArrays = (mode, first, count) => {
      if (mode === gl.POINTS && count === scene.clouds[0].pointCount()) ++draws;
      drawArrays(mode, first, count);
    };
    gl.bufferSubData = (target, at, data, offset, length) => {
      if (data.BYTES_PER_ELEMENT === 2 && length >= 4 * all) ++uploads;
      bufferSubData(target, at, data, offset, length);
    };
    const before = page.pictures, begin = performance.now();
    const look = () => {
      const came = window.remoteTouch.run.frameCount - frames;
      if (uploads < 3 || came < 3) setTimeout(look, 20);
      else done({ points: window.remoteTouch.run.frameAt().positions.length / 3, draws, uploads, pictures: page.pictures - before, frames: came, seconds: (performance.now() - begin) / 1000 });
    };
    look();
  });
}

test("the page shows the force that the device gets, and that it is limited", limit, async () => {
  const { address, stop } = await startLive("fig4.16", "--set", "safety.max_force_N=0.2");
  const { page, complaints } = await openLive(address);
  await until(page, (now) => now.time > 0.7, async () => {}); // the force has begun
  const touched = await touches(page);
  assert.ok(touched.force > 0.3 && touched.sent <= 0.2 + 1e-9, `limited to 0.2 N: ${JSON.stringify(touched)}`);
  const banner = () => page.evaluate(() => document.querySelector(".banner [data-kind=limited] span")?.textContent ?? "");
  while (!/^The device receives 0\.2 N of .*: limited for safety/.test(await banner())) {
    await page.mouse.wheel(0, -100); // deeper: where the hand rests, the force may be less than at the first touch
    await page.waitForTimeout(300);
  }
  assert.equal(await page.evaluate(() => window.remoteTouch.run.forceName), "device_force", "the arrow and the sound");
  const [, sent] = /force of the device ([\d.]+) N.*commanded/.exec(await page.textContent("figcaption")) ?? [];
  assert.ok(Number(sent) <= 0.2 + 1e-9, `the caption says ${sent} N`);
  assert.equal((await stop()).code, 0);
  assert.deepEqual(complaints, []);
});

test("what cannot run has no address", () => {
  const { status, stdout, stderr } = spawnSync(program, ["live", "fig4.16", "--view", "--depth", "dir:/nowhere"], { encoding: "utf8" });
  assert.equal(status, 2, stderr);
  assert.match(stderr, /nowhere/);
  assert.doesNotMatch(stdout, /http/);
});

// 300 000 points: a picture draws them once, and a frame is uploaded once.
test("fig4.16 with 880 x 660 pixels", limit, async () => {
  const { address, stop } = await startLive("fig4.16", "--set", "scenario.width=880", "--set", "scenario.height=660", "--set", "scenario.focal_px=722");
  const { page, complaints } = await openLive(address);
  const { uploads, draws, pictures, frames, points, seconds } = await page.evaluate(countWork);
  assert.ok(points > 250000, `${points} points`);
  assert.equal(draws, pictures, "one picture, one draw of the points");
  assert.ok(uploads <= frames + 1, `${uploads} uploads of points for ${frames} frames`);
  console.log(`880 x 660: ${points} points a frame, ${(pictures / seconds).toFixed(1)} pictures/s and ${(frames / seconds).toFixed(1)} frames/s with software graphics`);
  assert.equal((await stop()).code, 0);
  assert.deepEqual(complaints, []);
});

test("the banner says what the safety gate and the deadlines do, and axes keep their range", limit, async () => {
  const { address, stop } = await startLive("fig4.16");
  const { page, complaints } = await openLive(address);
  const said = await page.evaluate(() => {
    const { page: live, run } = window.remoteTouch, tick = run.ticks - 1;
    const kinds = () => Object.fromEntries([...document.querySelectorAll(".banner p")].map((line) => [line.dataset.kind, line.textContent]));
    const show = (gate, force, device_force, tick_interval) => {
      for (const [name, value] of Object.entries({ gate, force, device_force, tick_interval })) run.column(name).numbers.fill(value);
      live.banner.last = null;
      live.showTexts(tick);
      return kinds();
    };
    live.showHand(false); // its button stays while texts change
    const button = document.querySelector(".banner button");
    button.focus();
    const said = [show(2, 1, 1, 0.001), show(0, 1, 0, 0.001), show(1, 1, 0.5, 0.001), show(2, 1, 0.5, 0.004)];
    return document.activeElement === button ? said : [];
  });
  const of = (kind) => said.map((kinds) => kinds[kind]);
  assert.match(of("gate")[1], /^Force is off: the safety gate passes none of 1\.73 N until the hand is free\./);
  assert.match(of("limited")[2], /^The device receives 0\.866 N of 1\.73 N: the force begins slowly\.$/);
  assert.match(of("limited")[3], /: limited for safety, or to what the device can do\.$/);
  assert.match(of("deadlines")[3], /^This machine is too busy: (\d+) of \d+ ticks missed their deadline in the last 5 s, with a pause of up to 4 ms\./);
  assert.deepEqual([of("gate")[0], of("limited")[0], of("deadlines")[0], of("deadlines")[1], of("gate")[3]], Array(5).fill(undefined));

  const ranges = await page.evaluate(() => {
    const kept = new window.remoteTouch.KeptRange(), seen = (low, high, ms) => kept.of([low, high, 1], ms).slice(0, 2);
    return [seen(0, 10, 0), seen(2, 5, 1000), seen(0, 11, 2000), seen(0, 1, 3000), seen(0, 1, 12000), seen(0, 9, 12500), seen(0, 1, 13000), seen(0, 1, 24000)];
  });
  assert.deepEqual(ranges, [[0, 10], [0, 10], [0, 15], [0, 15], [0, 15], [0, 15], [0, 15], [0, 1]], "grows in round steps, shrinks after 10 s of little");
  const [before, after] = await page.evaluate(() => {
    const { page: live, run } = window.remoteTouch, [plot] = live.plots, before = [...plot.scale];
    run.column("force").numbers.fill(30);
    live.showTexts(run.ticks - 1);
    const high = [...plot.scale];
    run.column("force").numbers.fill(1);
    live.showTexts(run.ticks - 1);
    return [high, [...plot.scale], before];
  });
  assert.ok(before[1] > 30 && before[0] <= 1.8, `the axis has grown: ${before}`);
  assert.deepEqual(after, before, "and stays");
  assert.equal((await stop()).code, 0);
  assert.deepEqual(complaints, []);
});
