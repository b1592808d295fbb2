// Pages of results, as people use them. Usage: node pages.mjs PROGRAM CHROMIUM [EXPERIMENT... | all]
import assert from "node:assert/strict";
import { execFile, execFileSync, spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { test } from "node:test";
import { promisify } from "node:util";
import { goTo, noComplaints, openBrowser, openPage, picture, tick } from "./browser.mjs";

const [program, chromium, ...wanted] = process.argv.slice(2), all = wanted[0] === "all";
const remoteTouch = (...args) => execFileSync(program, ["-q", "--force", ...args], { encoding: "utf8" });
const columns = (trace, ticks, ...names) =>
  JSON.parse(execFileSync("/usr/bin/python3", ["columns.py", trace, ticks.join(","), ...names], { encoding: "utf8" }));

const browser = await openBrowser(chromium);
test.after(() => browser.close());

async function withPage(file, options, look) {
  const opened = await openPage(browser, file, options);
  try {
    await look(opened.page, opened);
    noComplaints(opened, file);
    const words = await opened.page.evaluate(() => document.body.innerText);
    assert.doesNotMatch(words, /NaN|Infinity|undefined|\[object/, `${file}: words of a programming language`);
  } finally {
    await opened.context.close();
  }
}

// Not blank, and other at another time.
async function showsMotion(page, ticks) {
  const pictures = [];
  for (const t of ticks) {
    await goTo(page, t);
    const now = await picture(page);
    assert.ok(now.drawn > 1000, `tick ${t}: only ${now.drawn} pixels are drawn`);
    pictures.push(now.hash);
  }
  assert.equal(new Set(pictures).size, ticks.length, "the picture does not change with the time");
}

async function showsStoredNumbers(page, trace, ticks, names) {
  const stored = columns(trace, ticks, ...names);
  await page.click("summary");
  for (const [i, t] of ticks.entries()) {
    await goTo(page, t);
    for (const name of names) {
      const [here, shown] = await page.evaluate(([column, at]) => {
        const found = window.remoteTouch.runs[0].column(column);
        const values = Array.from({ length: found.width }, (_, k) => found.value(at, k));
        const row = [...document.querySelectorAll(".values tr")].find((one) => one.firstChild.textContent === column);
        return [values, row.children[1].textContent];
      }, [name, t]);
      const expected = [stored[name][i]].flat();
      assert.deepEqual(here, expected, `${name} at tick ${t}`);
      shown.split(/ +/).forEach((text, k) => {
        const isRounding = text === "0" && Math.abs(expected[k]) < 1e-12, allowed = isRounding ? 1e-12 : 1e-4 * Math.abs(expected[k]);
        if (Number.isFinite(Number(text))) assert.ok(Math.abs(Number(text) - expected[k]) <= allowed, `${name} at tick ${t}: the page says ${shown}`);
      });
    }
  }
}

// Over a level plane: the drawn sheet is as far below the proxy as the column says.
async function sheetIsWhereTheColumnMeasures(page, ticks) {
  assert.match(await page.textContent(".legend"), /true surface at the last capture/);
  for (const t of ticks) {
    await goTo(page, t);
    const [drawnMm, storedMm] = await page.evaluate(() => {
      const { scene, runs, player } = window.remoteTouch, places = scene.truths[0].object.geometry.getAttribute("position");
      const proxy = runs[0].vector("proxy_position", player.tick);
      return [1000 * proxy[1] - places.getY((places.count - 1) / 2), 1000 * runs[0].column("signed_distance").value(player.tick)];
    });
    assert.ok(Math.abs(drawnMm - storedMm) < 0.001, `tick ${t}: the sheet is ${drawnMm} mm below the proxy, the column says ${storedMm} mm`);
  }
}

// The proxy is as far from the drawn cube, whose side is 85 mm, as the column says.
async function cubeIsWhereTheColumnMeasures(page, ticks) {
  for (const t of ticks) {
    await goTo(page, t);
    const [drawnMm, storedMm] = await page.evaluate(() => {
      const { scene, runs, player } = window.remoteTouch, cube = scene.trueMeshes.object.getObjectByName("cube");
      const place = cube.position.clone().set(...runs[0].vector("proxy_position", player.tick).map((x) => 1000 * x));
      const beyond = cube.worldToLocal(place).toArray().map((x) => Math.max(Math.abs(x) - 42.5, 0));
      return [Math.hypot(...beyond), 1000 * runs[0].column("signed_distance").value(player.tick)];
    });
    assert.ok(drawnMm > 0.1, `tick ${t}: the proxy is outside of the cube`);
    assert.ok(Math.abs(drawnMm - storedMm) < 0.002, `tick ${t}: the cube is ${drawnMm} mm from the proxy, the column says ${storedMm} mm`);
  }
}

// The ball of a run's slave, the command that it received and the force on it, as they are drawn: m and N. null: nothing is drawn.
async function drawnSlave(page, at, run = 0) {
  await goTo(page, at);
  return page.evaluate((which) => {
    const { scene } = window.remoteTouch, { object, shape, force, line } = scene.slaves[which], end = line.geometry.getAttribute("position");
    if (!object.visible) return null;
    const arrowMm = force.object.visible ? force.tip.position.y + force.tip.scale.y : 0, along = shape.position.clone().set(0, 1, 0);
    const metres = (mm) => mm.map((x) => x / 1000);
    return {
      radius: shape.geometry.parameters.radius / 1000, position: metres(shape.position.toArray()), command: metres([end.getX(1), end.getY(1), end.getZ(1)]),
      arrowAt: metres(force.object.position.toArray()), force: along.applyQuaternion(force.object.quaternion).multiplyScalar(arrowMm / scene.mmPerN).toArray(),
      longest: scene.longestMm / scene.mmPerN,
    };
  }, run);
}

function areClose(drawn, stored, most, what) {
  assert.ok(drawn.every((x, k) => Math.abs(x - stored[k]) <= most), `${what}: drawn ${drawn}, stored ${stored}`);
}

async function slaveIsWhereItsColumnsSay(page, trace, ticks) {
  const stored = columns(trace, ticks, "slave_position", "received_command", "slave_force");
  for (const [i, t] of ticks.entries()) {
    const drawn = await drawnSlave(page, t), force = stored.slave_force[i], newtons = Math.hypot(...force);
    areClose([drawn.radius], [0.005], 1e-9, "radius");
    areClose(drawn.position, stored.slave_position[i], 1e-7, `ball at tick ${t}`);
    areClose(drawn.command, stored.received_command[i], 1e-7, `command at tick ${t}`);
    if (newtons > 0) areClose(drawn.arrowAt, drawn.position, 1e-7, `arrow at tick ${t}`);
    areClose(drawn.force, force.map((x) => x * Math.min(1, drawn.longest / newtons || 1)), 1e-5, `force at tick ${t}`);
  }
}

async function picturesPerSecond(page) {
  return page.evaluate(() => new Promise((done) => {
    const { player, scene } = window.remoteTouch, draw = scene.draw.bind(scene), begin = performance.now();
    let count = 0;
    scene.draw = () => { draw(); ++count; };
    player.go(0);
    player.setSpeed(1);
    player.toggle();
    setTimeout(() => {
      player.stop();
      done((1000 * count) / (performance.now() - begin));
    }, 1500);
  }));
}

test("a trace: picture, motion and stored numbers", async () => {
  await withPage("a.html", {}, async (page, { firstPictureS }) => {
    await showsMotion(page, [100, 900, 1800]);
    await showsStoredNumbers(page, "a.h5", [0, 731, 1500], ["time", "force", "proxy_position", "contact_count", "signed_distance"]);
    const speed = all ? `, ${(await picturesPerSecond(page)).toFixed(0)} pictures/s while playing (software)` : "";
    console.log(`fig4.14: first picture after ${firstPictureS.toFixed(2)} s${speed}`);
  });
});

test("keys and buttons", async () => {
  await withPage("a.html", {}, async (page) => {
    await goTo(page, 500);
    await page.keyboard.press(".");
    assert.equal(await tick(page), 501);
    await page.keyboard.press(",");
    assert.equal(await tick(page), 500);
    await goTo(page, 0);
    const first = await page.evaluate(() => window.remoteTouch.runs[0].stored.events.find((event) => event.tick > 0).tick);
    await page.keyboard.press("e");
    assert.equal(await tick(page), first);
    await page.keyboard.press(" ");
    await page.waitForFunction((t) => window.remoteTouch.player.tick > t, first); // it plays
    await page.keyboard.press(" ");
    await page.click("text=Keys");
    assert.ok(await page.isVisible("dialog[open]"));
    await page.click("dialog[open] >> text=Close");
    await page.locator("figure canvas").first().click({ position: { x: 250, y: 40 } });
    const went = await tick(page);
    assert.ok(went > 500, `a click on a plot goes there: tick ${went}`);
    const before = await picture(page);
    await page.click("text=side");
    await page.click("text=follow");
    assert.notEqual((await picture(page)).hash, before.hash, "cameras differ");
    const away = await page.evaluate(() => {
      const { scene, runs, player } = window.remoteTouch, proxy = runs[0].vector("proxy_position", player.tick);
      return Math.hypot(...scene.controls.target.toArray().map((x, k) => x - 1000 * proxy[k]));
    });
    assert.ok(away < 1e-6, `the camera that follows looks ${away} mm beside the proxy`);
    await page.locator("aside select").selectOption("force");
    await page.keyboard.press(",");
    assert.equal(await tick(page), went - 1, "keys work after a choice");
  });
});

test("two traces open where they part", async () => {
  remoteTouch("run", "fig4.14", "--set", "renderer.stiffness_N_per_m=300", "-o", "b.h5");
  const { stdout } = spawnSync(program, ["compare", "a.h5", "b.h5", "--view", "both.html"], { encoding: "utf8" });
  const named = Number(/tick (\d+)/.exec(stdout)?.[1]);
  assert.ok(Number.isFinite(named), `compare names no tick: ${stdout}`);
  await withPage("both.html", {}, async (page) => {
    assert.equal(await tick(page), named);
    const beside = await page.textContent("aside");
    assert.match(beside, /difference of force/);
    assert.match(beside, /run 1: a\.h5; renderer\.stiffness_N_per_m 600/);
    assert.match(beside, /run 2: b\.h5; renderer\.stiffness_N_per_m 300/);
    assert.equal(await page.locator('.mark[title*="Run 2: The largest change of the force"]').count(), 1);
    await showsMotion(page, [400, 1700]);
  });
});

test("a sweep: a click on its map shows another run", async () => {
  remoteTouch("sweep", "fig4.13", "--set", "axes.0.count=12", "--set", "axes.1.count=10", "-o", "map.h5");
  remoteTouch("view", "map.h5", "-o", "map.html");
  await withPage("map.html", {}, async (page) => {
    await sheetIsWhereTheColumnMeasures(page, [100, 533, 700]);
    const proxyEnd = () => page.evaluate(() => window.remoteTouch.runs[0].vector("proxy_position", 790).join());
    const before = await proxyEnd(), cells = await page.locator(".map select").last().locator("option").count();
    assert.ok(cells >= 2, `${cells} runs on the page`);
    await page.locator(".map select").last().selectOption(String(cells - 1));
    assert.notEqual(await proxyEnd(), before);
    const box = await page.locator(".map canvas").boundingBox();
    const place = await page.evaluate(() => window.remoteTouch.sweep.place(window.remoteTouch.sweep.cellOf(0)));
    await page.mouse.click(box.x + 64 + ((place[1] + 0.5) * (box.width - 64)) / 10, box.y + ((11 - place[0] + 0.5) * (box.height - 34)) / 12);
    assert.equal(await proxyEnd(), before, "the click goes back to the first run");
    assert.equal(await page.locator("header").count(), 1);
    await showsMotion(page, [100, 700]);
  });
});

test("a slave is drawn where its columns say, with the force on it", async () => {
  remoteTouch("run", "steer-robot", "--set", "feedback.force=slave-force", "--set", "feedback.gain=0.5", "--set",
    "duration_s=1.2", "--set", "scenario.columns=20", "--set", "scenario.rows=20", "-o", "slave.h5");
  remoteTouch("view", "slave.h5", "-o", "slave.html");
  await withPage("slave.html", {}, async (page) => {
    const first = await tick(page), [strongest, tooStrong] = await page.evaluate(() => {
      const { runs: [run], scene } = window.remoteTouch, newtons = Array.from({ length: run.ticks }, (_, t) => run.column("slave_force").magnitude(t));
      const most = Math.max(...newtons);
      return [newtons.indexOf(most), most > scene.longestMm / scene.mmPerN];
    });
    const { slave_peak_force: [before, at] } = columns("slave.h5", [first - 1, first], "slave_peak_force");
    assert.ok(before === 0 && at > 0, `the page opens at the first contact: ${before} N, then ${at} N`);
    assert.ok(tooStrong, "the arrow of the strongest force is shorter than the force");
    await slaveIsWhereItsColumnsSay(page, "slave.h5", [100, first, first + 1, strongest]);
    const shown = await picture(page);
    await page.evaluate(() => { window.remoteTouch.scene.slaves[0].object.visible = false; });
    assert.notEqual((await picture(page)).hash, shown.hash, "it is in the picture");
    assert.match(await page.textContent(".legend"), /at most \d+ mm.*slave: ball, force on it, line to the command it received/);
    assert.match(await page.textContent("aside"), /force on the slave .*clearance of the slave /);
    // A slave that starts late: as before the first command.
    await page.evaluate(() => {
      for (const { name, numbers, width } of window.remoteTouch.runs[0].columns.values())
        if (/^slave_(?!command)|^received/.test(name)) numbers.fill(Number.NaN, 0, 500 * width);
    });
    assert.equal(await drawnSlave(page, 499), null);
    assert.notEqual(await drawnSlave(page, 500), null);
  });
});

test("a run without a slave beside one with a slave", async () => {
  remoteTouch("view", "a.h5", "slave.h5", "-o", "slaves.html");
  await withPage("slaves.html", {}, async (page) => {
    assert.equal(await drawnSlave(page, 1000, 0), null);
    areClose((await drawnSlave(page, 1000, 1)).position, columns("slave.h5", [1000], "slave_position").slave_position[0], 1e-7, "ball");
    const beside = await page.textContent("aside");
    for (const text of [/HIP, proxy and slave of run 2/, /slave: ball/, /force on the slave in run 2/]) assert.match(beside, text);
  });
});

test("the clock goes on when the first of two runs has ended", async () => {
  remoteTouch("view", "slave.h5", "a.h5", "-o", "longer.html");
  await withPage("longer.html", {}, async (page) => {
    const [first, second] = await page.evaluate(() => window.remoteTouch.runs.map((run) => run.ticks)), last = second - 1;
    assert.ok(second > first, `${first} and ${second} ticks`);
    await page.click("summary");
    await goTo(page, last);
    const [time] = columns("a.h5", [last], "time").time, row = page.locator(".values tr", { has: page.locator("th", { hasText: /^time$/ }) });
    assert.equal(await page.textContent("footer output"), `${time.toFixed(3)} s, tick ${last}`);
    assert.deepEqual((await row.locator("td").allTextContents()).slice(0, 2), ["-", String(time)]);
  });
});

const recording = `${process.env.REMOTE_TOUCH_DATA}/rgbd/visp_cube_dragon`;
test("true meshes are drawn at their poses", { skip: !existsSync(recording) && "recorded data are missing" }, async () => {
  remoteTouch("run", "fig4.16-moving", "--set", `scenario.path=${recording}`, "--set", "trajectory.row=310", "--set",
    "trajectory.column=290", "-o", "cube.h5");
  remoteTouch("view", "cube.h5", "-o", "cube.html");
  await withPage("cube.html", {}, async (page) => {
    assert.match(await page.textContent(".legend"), /true surface: cube, dragon, table/);
    assert.match(await page.textContent("aside"), /distance to the true surface/);
    await cubeIsWhereTheColumnMeasures(page, [300, 533, 567, 900, 1800]);
    const shown = await picture(page);
    await page.keyboard.press("t");
    const hidden = await picture(page);
    assert.ok(hidden.drawn < 0.7 * shown.drawn, `${shown.drawn} pixels with the meshes, ${hidden.drawn} without`);
    await page.keyboard.press("t");
    assert.equal((await picture(page)).hash, shown.hash);
  });
});

test("on a phone, in the dark", async () => {
  await withPage("a.html", { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, colorScheme: "dark", hasTouch: true }, async (page) => {
    const [width, dark] = await page.evaluate(() => [document.documentElement.scrollWidth, getComputedStyle(document.body).backgroundColor]);
    assert.ok(width <= 390, `${width} pixels wide`);
    assert.equal(dark, "rgb(22, 24, 27)");
    await showsMotion(page, [100, 1800]);
  });
});

test("without WebGL the page says so and shows the scene from the side", async () => {
  const plain = await openBrowser(chromium, ["--disable-gpu", "--disable-3d-apis"]);
  const opened = await openPage(plain, "a.html");
  try {
    assert.match(await opened.page.textContent(".note"), /No 3-D here/);
    await showsMotion(opened.page, [100, 1800]);
  } finally {
    await plain.close();
  }
});

function experiments() {
  const list = execFileSync(program, ["list"], { encoding: "utf8" }).split(/^(?=\S)/m).find((part) => part.startsWith("experiments"));
  return list.trim().split("\n").slice(1).map((line) => line.trim().split(/ +/)[0]);
}

const names = wanted[0] === "all" ? experiments() : wanted;
const execute = promisify(execFile);
// Of an experiment by its name alone: four of its six seconds, by a camera with a sixteenth of its pixels.
const smaller = { "fig7.5": ["duration_s=4", "scenario.width=160", "scenario.height=120", "scenario.focal_px=131.25"] };
async function makePage(name) {
  const sets = all ? [] : (smaller[name] ?? []).flatMap((one) => ["--set", one]);
  await execute(program, ["-q", "--force", "run", name, ...sets, "-o", `${name}.h5`]);
  await execute(program, ["-q", "--force", "view", `${name}.h5`, "-o", `${name}.html`, "--max-mb", "3"]);
}
// The page of the next experiment is made while the browser is busy with this one, and the first one from the beginning.
let coming = names.length > 0 ? makePage(names[0]) : undefined;
coming?.catch(() => {}); // its own test reports that
for (const [i, name] of names.entries())
  test(`a page of ${name}`, async () => {
    const made = coming;
    coming = i + 1 < names.length ? made.catch(() => {}).then(() => makePage(names[i + 1])) : undefined;
    coming?.catch(() => {}); // its own test reports that
    await made;
    await withPage(`${name}.html`, {}, async (page) => {
      const last = await page.evaluate(() => window.remoteTouch.player.ticks - 1);
      await showsMotion(page, [Math.floor(last / 5), last]);
    });
  });
