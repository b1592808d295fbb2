// Starts live runs and drives their pages in a browser, for live.mjs and live_link.mjs.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { test } from "node:test";
import { openBrowser, patience } from "./browser.mjs";

export const [program, chromium, all] = process.argv.slice(2);
export const limit = { timeout: 6 * patience };
export const browser = await openBrowser(chromium);
const children = [];
export const pages = []; // those of a test that failed are left
test.afterEach(async () => {
  for (const child of children.splice(0)) child.kill("SIGKILL");
  for (const page of pages.splice(0)) await page.close();
});
test.after(() => browser.close());

// A run until it is stopped; its address and, at the end, what it printed.
export async function startLive(...args) {
  return startLiveWith({}, ...args);
}
export async function startLiveWith(env, ...args) {
  const child = spawn(program, ["live", ...args, "--view"], { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, ...env } });
  children.push(child);
  let out = "", err = "";
  child.stderr.on("data", (data) => { err += data; });
  const ended = new Promise((done) => { child.on("exit", (code) => done({ code, out, err })); });
  const address = await new Promise((done, failed) => {
    child.stdout.on("data", (data) => {
      out += data;
      const found = /http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\//.exec(out);
      if (found) done(found[0]);
    });
    child.on("exit", () => failed(new Error(`live ended: ${err}`)));
  });
  const stop = () => {
    child.kill("SIGINT");
    return ended;
  };
  return { address, stop, signal: (name) => child.kill(name), ended };
}

export async function openLive(address) {
  const page = await browser.newPage({ viewport: { width: 480, height: 320 } }), complaints = [];
  pages.push(page);
  page.setDefaultTimeout(patience);
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !message.text().includes("GPU stall")) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(address);
  await page.waitForSelector("body[data-ready=yes]");
  return { page, complaints };
}

export const newest = (page) => page.evaluate(() => {
  const { run } = window.remoteTouch, tick = run.ticks - 1;
  return {
    tick, time: run.column("time").value(tick), hip: run.vector("hip_position", tick), force: run.column("force").magnitude(tick),
    sent: run.column("device_force").magnitude(tick), contacts: run.column("contact_count").value(tick), frames: run.frameCount, pictures: window.remoteTouch.page.pictures,
  };
});

export async function until(page, holds, act) {
  const end = Date.now() + patience;
  for (let now = await newest(page); Date.now() < end; now = await newest(page)) {
    if (holds(now)) return now;
    await act();
    await page.waitForTimeout(20);
  }
  return newest(page);
}

export async function middle(page) {
  const box = await page.locator(".picture canvas").boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
}

// The hand follows the mouse by as much as the picture moves, and in its plane.
export async function dragMovesTheHand(page) {
  await rests(page); // beside a load the hand may still follow an earlier motion
  const [x, y] = await middle(page), before = await newest(page);
  const [right, mm] = await page.evaluate((hip) => {
    const { scene } = window.remoteTouch, place = scene.directions()[0].clone().set(1000 * hip[0], 1000 * hip[1], 1000 * hip[2]);
    return [scene.directions()[0].toArray(), scene.mmPerPixel(place)];
  }, before.hip);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y, { steps: 5 }); // each step waits for a picture
  await page.mouse.up();
  const moved = (now) => now.hip.reduce((sum, h, k) => sum + 1000 * (h - before.hip[k]) * right[k], 0);
  const after = await until(page, (now) => Math.abs(moved(now) - 60 * mm) < 1.5, async () => {});
  assert.ok(Math.abs(moved(after) - 60 * mm) < 1.5, `dragged by ${60 * mm} mm, moved by ${moved(after)} mm`);
  await page.mouse.move(x + 60, y);
  await page.mouse.down();
  await page.mouse.move(x, y, { steps: 5 });
  await page.mouse.up();
  await rests(page);
}

export const distance = (a, b) => Math.hypot(...a.map((x, k) => x - b[k]));

// Until the hand, which follows the mouse with a lag, has not moved for 0.2 s.
export async function rests(page) {
  let since = await newest(page);
  await until(page, (now) => {
    if (distance(now.hip, since.hip) > 1e-9) since = now;
    return now.time > since.time + 0.2;
  }, async () => {});
}

// What the banner and the line below the picture say.
export const says = (page, kind, text) => page.waitForFunction(([of, pattern]) => new RegExp(pattern).test(document.querySelector(`.banner [data-kind=${of}] span`)?.textContent),
  [kind, text.source]);
export const saysNothing = (page, kind) => page.waitForFunction((of) => !document.querySelector(`.banner [data-kind=${of}]`), kind);
export const hint = (page, text) => page.waitForFunction((pattern) => new RegExp(pattern).test(document.querySelector("footer span").textContent), text.source);
