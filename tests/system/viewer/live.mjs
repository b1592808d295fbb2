// A live run in a browser: the mouse as the hand, and who is refused. Usage: node live.mjs PROGRAM CHROMIUM [all]
// The experiments with a recording run only with all: each takes minutes with software graphics.
import assert from "node:assert/strict";
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { test } from "node:test";
import { openBrowser, patience, picture } from "./browser.mjs";

const [program, chromium, all] = process.argv.slice(2);
const limit = { timeout: 6 * patience };
const browser = await openBrowser(chromium);
const children = [], pages = []; // those of a test that failed are left
test.afterEach(async () => {
  for (const child of children.splice(0)) child.kill("SIGKILL");
  for (const page of pages.splice(0)) await page.close();
});
test.after(() => browser.close());

// A run until it is stopped; its address and, at the end, what it printed.
async function startLive(...args) {
  const child = spawn(program, ["live", ...args, "--view"], { stdio: ["ignore", "pipe", "pipe"] });
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

async function openLive(address) {
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

const newest = (page) => page.evaluate(() => {
  const { run } = window.remoteTouch, tick = run.ticks - 1;
  return {
    tick, time: run.column("time").value(tick), hip: run.vector("hip_position", tick), force: run.column("force").magnitude(tick),
    sent: run.column("device_force").magnitude(tick), contacts: run.column("contact_count").value(tick), frames: run.frameCount, pictures: window.remoteTouch.page.pictures,
  };
});

async function until(page, holds, act) {
  const end = Date.now() + patience;
  for (let now = await newest(page); Date.now() < end; now = await newest(page)) {
    if (holds(now)) return now;
    await act();
    await page.waitForTimeout(20);
  }
  return newest(page);
}

async function middle(page) {
  const box = await page.locator(".picture canvas").boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
}

// The hand follows the mouse by as much as the picture moves, and in its plane.
async function dragMovesTheHand(page) {
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
  const after = await until(page, (now) => Math.abs(moved(now) - 60 * mm) < 1, async () => {});
  assert.ok(Math.abs(moved(after) - 60 * mm) < 1.5, `dragged by ${60 * mm} mm, moved by ${moved(after)} mm`);
  await page.mouse.move(x + 60, y);
  await page.mouse.down();
  await page.mouse.move(x, y, { steps: 5 });
  await page.mouse.up();
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
    const touched = await touches(page);
    assert.ok(touched.contacts > 0 && touched.force > 0.3, `no contact: ${JSON.stringify(touched)}`);
    const shown = await picture(page);
    assert.ok(shown.drawn > 2000, "the picture is blank");
    console.log(`${name}: ${(await changesParameters(page)).join("; ")}`);
    const { uploads, draws, pictures, frames } = await page.evaluate(countWork);
    assert.equal(draws, pictures, "one picture, one draw of the points");
    assert.ok(uploads <= frames + 1, `${uploads} uploads of points for ${frames} frames`);
    console.log(`${name}: ${JSON.stringify({ ...touched, drawn: shown.drawn })}`);
    const { code, out } = await stop();
    assert.equal(code, 0, out);
    assert.deepEqual(complaints, []);
    await page.waitForSelector("body[data-state=ended]", { state: "attached" });
    assert.equal(await page.textContent("footer .status"), "The run has ended: stopped by a signal. The picture is its last one.");
    assert.ok(await page.evaluate(() => document.querySelector("fieldset.sliders").disabled), "nothing is left to set");
    assert.equal(digestOffline(`${name}.session.h5`), /digest of the trace: ([0-9a-f]{64})/.exec(out)[1]);
    await page.close();
  });

// Until three frames came and their points were uploaded three times: uploads, draws of all points, pictures and frames.
function countWork() {
  return new Promise((done) => {
    const { scene, page } = window.remoteTouch, gl = document.querySelector(".picture canvas").getContext("webgl2");
    const frames = window.remoteTouch.run.frameCount;
    let draws = 0, uploads = 0;
    const [drawArrays, bufferSubData] = [gl.drawArrays.bind(gl), gl.bufferSubData.bind(gl)];
    gl.drawArrays = (mode, first, count) => {
      if (mode === gl.POINTS && count === scene.clouds[0].pointCount()) ++draws;
      drawArrays(mode, first, count);
    };
    gl.bufferSubData = (target, at, data, offset, length) => {
      if (data.BYTES_PER_ELEMENT === 2 && length >= 4 * scene.clouds[0].pointCount()) ++uploads;
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
  await page.waitForFunction(() => /The device receives 0\.2 N of .*: limited for safety/.test(document.querySelector("footer .limited").textContent));
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

test("who is refused, and the run goes on", limit, async () => {
  const { address, stop } = await startLive("fig4.16");
  const { page } = await openLive(address);
  const port = new URL(address).port, wrong = address.replace(/[0-9a-f]{32}/, "0".repeat(32));
  assert.equal((await fetch(wrong)).status, 404, "a wrong secret");
  assert.equal((await fetch(`http://127.0.0.1:${port}/`)).status, 404, "no secret");
  assert.equal((await fetch(`${wrong}state`)).status, 404, "the state with a wrong secret");
  assert.deepEqual(await (await fetch(`${address}state`)).json(), { protocol: 2, ended: "", full: false });
  const stranger = await browser.newPage();
  pages.push(stranger);
  await stranger.goto("data:text/html,x");
  const opened = await stranger.evaluate((place) => new Promise((done) => {
    const socket = new WebSocket(place);
    socket.onopen = () => done(true);
    socket.onerror = () => done(false);
  }), `${address.replace("http", "ws")}channel?1`);
  assert.equal(opened, false, "a page of another origin");
  const before = await newest(page);
  await until(page, (now) => now.time > before.time + 0.2, async () => {});

  // The hand's page sends 20 000 messages of random bytes.
  const hip = (await newest(page)).hip;
  await page.evaluate(async () => {
    const { connection } = window.remoteTouch;
    for (let i = 0; i < 20000; ++i) {
      const bytes = new Uint8Array(Math.floor(65 * Math.random()));
      crypto.getRandomValues(bytes);
      connection.socket.send(bytes);
      if (connection.socket.bufferedAmount > 1e5) await new Promise((done) => { setTimeout(done, 5); });
    }
  });
  const after = await newest(page);
  const later = await until(page, (now) => now.time > after.time + 0.5, async () => {});
  assert.ok(later.time > after.time + 0.5, "the run goes on");
  assert.deepEqual(later.hip, hip, "nobody moved the hand");
  assert.equal((await stop()).code, 0);
});

// The texts of the page about its connection, each once, as they change.
async function recordStates(page) {
  await page.evaluate(() => {
    window.states = [{ state: "open", text: "" }];
    new MutationObserver(() => {
      const { state } = document.body.dataset;
      if (window.states.at(-1).state !== state) window.states.push({ state, text: document.querySelector("footer .status").textContent });
    }).observe(document.body, { attributes: true, attributeFilter: ["data-state"] });
  });
}
const says = (page, part, text) => page.waitForFunction(([selector, pattern]) => new RegExp(pattern).test(document.querySelector(selector).textContent),
  [`footer ${part}`, text.source]);

test("each page says who has the hand, and what is with the run and the connection", limit, async () => {
  const { address, signal, ended } = await startLive("fig4.16");
  const { page } = await openLive(address), { page: watching } = await openLive(address);
  await says(watching, "span", /^Another page controls the hand\. This page only watches/);
  const before = await newest(watching), [x, y] = await middle(watching);
  await watching.mouse.move(x, y);
  await watching.mouse.down();
  await watching.mouse.move(x + 60, y, { steps: 5 });
  await watching.mouse.up();
  const after = await until(watching, (now) => now.time > before.time + 0.2, async () => {});
  assert.deepEqual(after.hip, before.hip, "a page that watches moves nothing");
  assert.ok(await watching.evaluate(() => document.querySelector("fieldset.sliders").disabled), "nor sets anything");

  // A message that is too long ends the connection. The page connects again by itself; the other one has got the hand.
  await recordStates(page);
  await page.evaluate(() => window.remoteTouch.connection.socket.send(new Uint8Array(100000)));
  await page.waitForFunction(() => window.states.length > 1 && window.states.at(-1).state === "open" && window.remoteTouch.run.ticks > 0);
  const states = await page.evaluate(() => window.states);
  assert.deepEqual(states.map(({ state }) => state), ["open", "lost", "open"]);
  await says(page, "span", /^Another page controls the hand/);
  await page.close();
  await says(watching, "span", /^Drag to move the hand/);
  await dragMovesTheHand(watching);

  // The first statement gives way to the second after four seconds, which may be less than a picture takes: the page does
  // not look at the connection until the first has been seen. Beside a load it may have called the connection silent just
  // before, and then it shows the first statement only after the next data. The statement about a late camera may follow.
  await watching.evaluate(() => { window.remoteTouch.connection.look = () => {}; });
  await watching.waitForFunction(() => document.body.dataset.state === "open");
  signal("SIGSTOP"); // as when the machine sleeps
  await says(watching, ".status", /^No tick has arrived for \d+ s: the picture is the last one\. /);
  await watching.evaluate(() => { delete window.remoteTouch.connection.look; });
  await says(watching, ".status", /^No data has arrived for \d+ s: the program or the connection to it hangs\./);
  signal("SIGCONT");
  await says(watching, ".status", /^$/);
  assert.equal(await watching.evaluate(() => { // at once, before the run says that all is well
    window.remoteTouch.page.showTrouble({ camera: "no frame for 0.2 s: the last cloud is still rendered", force: "the hand is too fast" });
    return document.querySelector("footer .status").textContent;
  }), "No frame for 0.2 s: the last cloud is still rendered. Force is off: the hand is too fast. ");

  signal("SIGKILL");
  await ended;
  await says(watching, ".status", /^Nothing answers at 127\.0\.0\.1:\d+: the program was ended or killed.* Trying again.* \(attempt ([2-9]|\d\d+)\)\.$/);
  assert.ok(await watching.evaluate(() => document.querySelector("fieldset.sliders").disabled), "nothing is left to set");
  await watching.route("**/state*", (route) => route.fulfill({ status: 404 }));
  await says(watching, ".status", /^Another run or program is at 127\.0\.0\.1:\d+ now/);
  assert.equal(await watching.evaluate(() => document.body.dataset.state), "other");
  assert.deepEqual(await watching.evaluate(() => {
    const { stateOf } = window.remoteTouch;
    return ["late", { status: 200, protocol: 2 }, { status: 200, protocol: 2, ended: "its duration has elapsed" }, { status: 200, protocol: 2, full: true },
      { status: 200, protocol: 1 }, { status: 200 }].map((answer) => stateOf(answer, 2).kind);
  }), ["lost", "lost", "ended", "full", "version", "version"]);
});
