// The connection of a live page: who is refused, and what the page says when the run or the connection ends.
// Usage: node live_link.mjs PROGRAM CHROMIUM
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { request } from "node:http";
import { connect, createServer } from "node:net";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { test } from "node:test";
import { browser, distance, dragMovesTheHand, hint, limit, middle, newest, openLive, pages, says, saysNothing, startLive, startLiveWith, until } from "./live_driver.mjs";

// The status and the text that a request with these headers gets. A browser sets them by itself.
function answerTo(port, path, headers) {
  return new Promise((done, failed) => {
    const asked = request({ host: "127.0.0.1", port, path, headers }, (answer) => {
      let text = "";
      answer.on("data", (data) => { text += data; }).on("end", () => done({ status: answer.statusCode, text }));
    });
    asked.on("upgrade", (answer, socket) => {
      socket.destroy();
      done({ status: answer.statusCode, text: "" });
    }).on("error", failed).end();
  });
}

// As ssh -L does, whatever port is free on the user's machine.
test("the page works through a tunnel from another port", limit, async () => {
  const { address, stop } = await startLive("fig4.16");
  const { port, pathname } = new URL(address);
  const tunnel = createServer((near) => {
    const far = connect(Number(port), "127.0.0.1");
    near.pipe(far).pipe(near);
    for (const end of [near, far]) end.on("error", () => { near.destroy(); far.destroy(); });
  });
  await new Promise((done) => { tunnel.listen(0, "127.0.0.1", done); });
  const { page, complaints } = await openLive(`http://localhost:${tunnel.address().port}${pathname}`);
  await dragMovesTheHand(page);
  assert.equal((await stop()).code, 0);
  tunnel.close();
  assert.deepEqual(complaints, []);
});

// Browsers in a snap cannot read the temporary folder, nor names that begin with a dot.
test("the browser of the desktop gets a file of the home folder", limit, async () => {
  const home = mkdtempSync(join(tmpdir(), "home-"));
  writeFileSync(join(home, "xdg-open"), `#!/bin/sh\ncp "$1" "$HOME/copy"\necho "$1" >"$HOME/new"\nmv "$HOME/new" "$HOME/argument"\n`, { mode: 0o755 });
  const { address, stop } = await startLiveWith({ HOME: home, DISPLAY: ":77", PATH: `${home}:${process.env.PATH}` }, "fig4.16");
  while (!existsSync(join(home, "argument"))) await new Promise((done) => { setTimeout(done, 50); });
  const file = readFileSync(join(home, "argument"), "utf8").trim();
  assert.equal(dirname(file), home);
  assert.match(basename(file), /^remote-touch-live-\w+\.html$/);
  assert.ok(readFileSync(join(home, "copy"), "utf8").includes(`url=${address}"`));
  assert.equal((await stop()).code, 0);
  assert.ok(!existsSync(file), "removed at the end");
  rmSync(home, { recursive: true });
});

test("who is refused, and the run goes on", limit, async () => {
  const { address, stop } = await startLive("fig4.16");
  const { page } = await openLive(address);
  const port = new URL(address).port, wrong = address.replace(/[0-9a-f]{32}/, "0".repeat(32));
  assert.equal((await fetch(wrong)).status, 404, "a wrong secret");
  assert.equal((await fetch(`http://127.0.0.1:${port}/`)).status, 404, "no secret");
  assert.match(await (await fetch(`http://127.0.0.1:${port}/`)).text(), /open the whole address\nthat the terminal prints/);
  assert.equal((await fetch(`${wrong}state`)).status, 404, "the state with a wrong secret");
  const { pathname } = new URL(address), upgrade = {
    Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
  };
  const rebound = await answerTo(port, pathname, { Host: `example.org:${port}` });
  assert.equal(rebound.status, 403, "another host name");
  assert.match(rebound.text, new RegExp(`ssh -L 8000:127\\.0\\.0\\.1:${port} `));
  for (const Origin of [`http://127.0.0.1:${Number(port) - 1}`, "http://example.org", `http://localhost:${port}`, "null"])
    assert.equal((await answerTo(port, `${pathname}channel?1`, { Host: `127.0.0.1:${port}`, Origin, ...upgrade })).status, 403, Origin);
  assert.deepEqual(await (await fetch(`${address}state`)).json(), { protocol: 3, ended: "", full: false });
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

  const waiting = await browser.newPage();
  pages.push(waiting);
  await waiting.addInitScript(() => { window.WebSocket = class extends EventTarget {}; }); // nobody answers it
  await waiting.goto(address);
  await waiting.waitForFunction((place) => document.body.textContent === `Connecting to the run at ${place}.`, new URL(address).host);

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
      if (window.states.at(-1).state !== state) window.states.push({ state, text: document.querySelector(".banner").textContent });
    }).observe(document.body, { attributes: true, attributeFilter: ["data-state"] });
  });
}

test("each page says who has the hand, and what is with the run and the connection", limit, async () => {
  const { address, signal, ended } = await startLive("fig4.16");
  const { page } = await openLive(address), { page: watching } = await openLive(address);
  await says(watching, "watches", /^Another page controls the hand\. This page only watches/);
  await saysNothing(page, "watches");
  const before = await newest(watching), [x, y] = await middle(watching);
  await watching.mouse.move(x, y);
  await watching.mouse.down();
  await watching.mouse.move(x + 60, y, { steps: 5 });
  await watching.mouse.up();
  const after = await until(watching, (now) => now.time > before.time + 0.2, async () => {});
  assert.deepEqual(after.hip, before.hip, "a page that watches moves nothing");
  assert.ok(await watching.evaluate(() => document.querySelector("fieldset.sliders").disabled), "nor sets anything");

  // It takes the hand over, which stays where it is, and back.
  for (const [one, other] of [[watching, page], [page, watching]]) {
    const there = (await newest(one)).hip;
    await one.click(".banner button");
    await saysNothing(one, "watches");
    await says(other, "watches", /^Another page has taken over the hand\. This page only watches now\./);
    await hint(one, /^Drag to move the hand/);
    assert.ok(distance((await newest(one)).hip, there) < 1e-6, "the take-over moves nothing");
    await dragMovesTheHand(one);
  }
  assert.equal(await page.evaluate(() => { // the hand is this page's again, which does not know yet where it is
    for (const has of [false, true]) window.remoteTouch.page.showHand(has);
    return document.querySelector("footer span").textContent;
  }), "");
  await hint(page, /^Drag to move the hand/);

  // A message that is too long ends the connection. The page connects again by itself; the other one has got the hand.
  await recordStates(page);
  await page.evaluate(() => window.remoteTouch.connection.socket.send(new Uint8Array(100000)));
  await page.waitForFunction(() => window.states.length > 1 && window.states.at(-1).state === "open" && window.remoteTouch.run.ticks > 0);
  const states = await page.evaluate(() => window.states);
  assert.deepEqual(states.map(({ state }) => state), ["open", "lost", "open"]);
  await says(page, "watches", /^Another page (controls|has taken over) the hand/);
  await page.close();
  await hint(watching, /^Drag to move the hand/);
  await dragMovesTheHand(watching);

  // The first statement gives way to the second after four seconds, which may be less than a picture takes: the page does
  // not look at the connection until the first has been seen. Beside a load it may have called the connection silent just
  // before, and then it shows the first statement only after the next data. The statement about a late camera may follow.
  await watching.evaluate(() => { window.remoteTouch.connection.look = () => {}; });
  await watching.waitForFunction(() => document.body.dataset.state === "open");
  signal("SIGSTOP"); // as when the machine sleeps
  await says(watching, "ticks", /^No tick has arrived for \d+ s: the picture is the last one\.$/);
  await watching.evaluate(() => { delete window.remoteTouch.connection.look; });
  await says(watching, "silent", /^No data has arrived for \d+ s: the program or the connection to it hangs\./);
  signal("SIGCONT");
  await saysNothing(watching, "silent");
  await saysNothing(watching, "ticks");
  assert.deepEqual(await watching.evaluate(() => { // at once, before the run says that all is well
    window.remoteTouch.page.showTrouble({ camera: "no frame for 0.2 s: the last cloud is still rendered", force: "the hand is too fast" });
    return ["camera", "gate"].map((kind) => document.querySelector(`.banner [data-kind=${kind}]`).textContent);
  }), ["No frame for 0.2 s: the last cloud is still rendered.", "Force is off: the hand is too fast."]);

  signal("SIGKILL");
  await ended;
  await says(watching, "gone", /^Nothing answers at 127\.0\.0\.1:\d+: the program was ended or killed.* Trying again.* \(attempt ([2-9]|\d\d+)\)\.$/);
  assert.ok(await watching.evaluate(() => document.querySelector("fieldset.sliders").disabled), "nothing is left to set");
  await watching.route("**/state*", (route) => route.fulfill({ status: 404 }));
  await says(watching, "other", /^Another run or program is at 127\.0\.0\.1:\d+ now/);
  assert.equal(await watching.evaluate(() => document.body.dataset.state), "other");
  assert.deepEqual(await watching.evaluate(() => {
    const { stateOf } = window.remoteTouch;
    return ["late", { status: 200, protocol: 3 }, { status: 200, protocol: 3, ended: "its duration has elapsed" }, { status: 200, protocol: 3, full: true },
      { status: 200, protocol: 2 }, { status: 200 }].map((answer) => stateOf(answer, 3).kind);
  }), ["lost", "lost", "ended", "full", "version", "version"]);
});
