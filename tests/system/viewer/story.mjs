// What the page of a run tells: where it opens, its events, its plots, its address. Usage: node story.mjs PROGRAM CHROMIUM
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { goTo, noComplaints, openBrowser, openPage, tick } from "./browser.mjs";

const [program, chromium] = process.argv.slice(2), { colours } = JSON.parse(readFileSync("colours.json"));
const remoteTouch = (...args) => execFileSync(program, ["-q", "--force", ...args], { encoding: "utf8" });
function makePage(name, ...args) {
  remoteTouch("run", ...args, "-o", `${name}.h5`);
  remoteTouch("view", `${name}.h5`, "-o", `${name}.html`);
}
makePage("pop", "fig4.12", "--set", "scenario.acceleration_m_per_s2=15"); // the proxy pops through
makePage("jump", "fig4.16", "--set", "duration_s=1"); // a camera, and no pop-through
makePage("long", "fig4.14", "--set", "duration_s=15");
remoteTouch("run", "fig4.12", "--set", "scenario.acceleration_m_per_s2=3", "-o", "calm.h5"); // it does not
remoteTouch("view", "calm.h5", "pop.h5", "-o", "both.html");

const browser = await openBrowser(chromium);
test.after(() => browser.close());

async function withPage(file, options, look, hash = "") {
  const opened = await openPage(browser, file, options, hash);
  try {
    await look(opened.page);
    noComplaints(opened, file);
  } finally {
    await opened.context.close();
  }
}
const nextPicture = (page) => page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); }));
const axis = (page) => page.evaluate(() => {
  const { first, shown, ticks } = window.remoteTouch.plots.axis;
  return { first, shown, ticks };
});
const events = (page) => page.evaluate(() => window.remoteTouch.runs[0].stored.events);

// The width of the proxy in pixels, the angle between force and line of sight, and the head of its arrow in contact radii.
const view = (page) => page.evaluate(() => {
  const { scene, runs, player } = window.remoteTouch, run = runs[0], sight = scene.directions()[2];
  const force = sight.clone().set(...run.vector(run.forceName, player.tick)).normalize();
  const proxy = sight.clone().set(...run.vector("proxy_position", player.tick)).multiplyScalar(1000), radius = 1000 * run.contactRadiusM;
  return {
    wide: (2 * radius) / scene.mmPerPixel(proxy), degrees: (Math.acos(Math.abs(force.dot(sight))) * 180) / Math.PI,
    up: scene.camera.up.toArray(), right: scene.directions()[0].toArray(), head: scene.hands[0].force.tip.scale.y / radius,
    centre: proxy.clone().project(scene.camera).toArray(),
  };
});

for (const [name, kind] of [["pop", "pop-through"], ["jump", "force jump"]])
  test(`a page opens at the ${kind}, across the force`, async () => {
    await withPage(`${name}.html`, {}, async (page) => {
      const all = await events(page);
      assert.equal(all.some((event) => event.kind === "pop-through"), kind === "pop-through");
      assert.equal(await tick(page), all.find((event) => event.kind === kind).tick);
      const seen = await view(page);
      assert.ok(seen.wide >= 25, `the proxy is ${seen.wide} pixels wide`);
      assert.ok(seen.head <= 1.5, `the head of the arrow is ${seen.head} r_c long`);
      assert.ok(kind === "pop-through" || seen.degrees > 60, `the force is ${seen.degrees} degrees from the line of sight`);
      assert.deepEqual(seen.up, [0, 1, 0]);
      assert.ok(Math.abs(seen.right[1]) < 1e-9, "the horizon is level");
      assert.ok(Math.hypot(seen.centre[0], seen.centre[1]) < 0.01, "the proxy is in the middle");
    });
  });

test("events are a list in words, with next and previous", async () => {
  await withPage("pop.html", {}, async (page) => {
    const all = await events(page), texts = await page.locator(".events button").allTextContents();
    assert.deepEqual(texts, all.map((event) => `tick ${event.tick}: ${event.text}`));
    assert.ok(texts.some((text) => /^tick \d+: The proxy's centre passes behind the true surface\.$/.test(text)), texts.join("\n"));
    const ticks = [...new Set(all.map((event) => event.tick))], last = ticks.at(-1);
    const marks = await page.evaluate(() => [...window.remoteTouch.plots.svg().matchAll(/<rect[^>]*fill="(#\w+)"/g)].map((found) => found[1]));
    assert.equal(marks.at(-1), colours["pop-through"].light, "the mark of the pop-through lies above those of the same tick");
    await page.locator(".events button").last().click();
    assert.equal(await tick(page), last);
    assert.equal(await page.locator(".events [aria-current=time]").last().textContent(), texts.at(-1));
    await page.click("text=Previous event");
    assert.equal(await tick(page), ticks.at(-2));
    await page.click("text=Next event");
    assert.equal(await tick(page), last);
    await page.keyboard.press("E");
    assert.equal(await tick(page), ticks.at(-2));
  });
});

test("the list of events shows the current one, and is one stop of the keyboard", async () => {
  await withPage("pop.html", {}, async (page) => {
    await page.addStyleTag({ content: ".events ol { max-height: 50px; }" });
    const all = await events(page), isSeen = () => page.evaluate(() => {
      const box = document.querySelector(".events ol").getBoundingClientRect(), row = document.querySelector(".events [aria-current=time]").getBoundingClientRect();
      return row.top >= box.top - 1 && row.bottom <= box.bottom + 1;
    });
    for (const event of [all.at(-1), all[0], all.at(-1)]) {
      await goTo(page, event.tick);
      assert.ok(await isSeen(), `tick ${event.tick}`);
    }
    assert.equal(await page.locator(".events button[tabindex='0']").count(), 1);
    await page.locator(".events button[tabindex='0']").focus();
    await page.keyboard.press("Home");
    await page.keyboard.press("ArrowDown");
    assert.equal(await page.evaluate(() => document.activeElement.textContent), `tick ${all[1].tick}: ${all[1].text}`);
    await page.keyboard.press("Enter");
    assert.equal(await tick(page), all[1].tick);
  });
});

test("marks of events do not hide the slider", async () => {
  await withPage("pop.html", {}, async (page) => {
    const sizes = await page.locator(".mark").evaluateAll((all) => all.map((one) => [one.offsetWidth, one.offsetHeight]));
    assert.ok(sizes.length > 1 && sizes.every(([width, height]) => width <= 8 && height <= 12), sizes.join(" "));
  });
});

test("two runs have their story in one sentence", async () => {
  await withPage("both.html", {}, async (page) => {
    const pop = await page.evaluate(() => window.remoteTouch.runs.map((run) => run.events.find((event) => event.kind === "pop-through")?.tick));
    assert.equal(pop[0], undefined);
    assert.equal(await page.textContent(".story"), `Run 2 pops through at ${(pop[1] / 1000).toFixed(3)} s, run 1 does not.`);
  });
});

test("the shown time is not cut off, and controls are large enough, at any width", async () => {
  for (const width of [1440, 1024, 390])
    await withPage("jump.html", { viewport: { width, height: 800 } }, async (page) => {
      const [inside, right] = await page.evaluate(() => {
        const range = document.querySelector(".zoom output"), side = document.querySelector("aside").getBoundingClientRect();
        return [range.scrollWidth <= range.clientWidth + 1, side.right - range.getBoundingClientRect().right];
      });
      assert.ok(inside && right >= 0, `${width} pixels: ${inside}, ${right} pixels left`);
      const sizes = await page.locator(":is(button, input, select):not(.mark):visible").evaluateAll((all) => all.map((one) => Math.min(one.offsetWidth, one.offsetHeight)));
      assert.ok(Math.min(...sizes) >= 24, `${width} pixels: ${sizes}`);
    });
});

test("no arrow is longer than the legend says", async () => {
  await withPage("pop.html", {}, async (page) => {
    const [long, most] = await page.evaluate(() => {
      const { scene } = window.remoteTouch, { velocity } = scene.hands[0];
      velocity.show([0, 0, 0], [0, 100, 0], 1000 / 15);
      return [velocity.tip.position.y + velocity.tip.scale.y, scene.longestMm];
    });
    assert.ok(Math.abs(long - most) < 1e-6, `${long} mm, at most ${most} mm`);
  });
});

test("a stored page may not reach the network", async () => {
  const opened = await openPage(browser, "jump.html");
  try {
    assert.equal(await opened.page.evaluate(() => fetch("https://example.org/").then(() => "reached", (error) => error.name)), "TypeError");
    assert.ok(opened.complaints.some((text) => text.includes("Content Security Policy")), opened.complaints.join("\n"));
  } finally {
    await opened.context.close();
  }
});

test("the address names the moment, and the history stays short", async () => {
  await withPage("jump.html", {}, async (page) => {
    assert.equal(await tick(page), 321);
    const before = await page.evaluate(() => history.length);
    for (let i = 0; i < 5; ++i) await page.keyboard.press(".");
    await page.waitForFunction(() => location.hash === "#tick=326");
    assert.equal(await page.evaluate(() => history.length), before);
    await page.evaluate(() => { location.hash = "#tick=12"; });
    await page.waitForFunction(() => window.remoteTouch.player.tick === 12);
  }, "#tick=321");
  for (const wrong of ["1000", "-1", "x"])
    await withPage("jump.html", {}, async (page) => {
      assert.equal(await page.textContent("footer small"), `address: tick=${wrong}: expected 0 to 999`);
      assert.equal(await tick(page), (await events(page)).find((event) => event.kind === "force jump").tick);
    }, `#tick=${wrong}`);
});

test("all plots zoom and move together", async () => {
  await withPage("jump.html", {}, async (page) => {
    const canvas = page.locator("aside figure canvas").first(), box = await canvas.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + 40);
    await page.mouse.wheel(0, -400);
    await page.waitForFunction(() => window.remoteTouch.plots.axis.shown < 1000);
    await nextPicture(page);
    const zoomed = await axis(page);
    assert.ok(Math.abs(zoomed.shown / zoomed.ticks - Math.exp(-0.8)) < 0.01, `${zoomed.shown} ticks`);
    const windows = await page.evaluate(() => window.remoteTouch.plots.plots.map((plot) => [plot.first, plot.ticks].join()));
    assert.deepEqual(new Set(windows), new Set([`${Math.round(zoomed.first)},${Math.round(zoomed.shown)}`]));
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 60, box.y + 40, { steps: 4 });
    await page.mouse.up();
    const moved = await axis(page), expected = zoomed.first - (60 * (zoomed.shown - 1)) / (box.width - 61);
    assert.ok(Math.abs(moved.first - Math.max(expected, 0)) < 2, `moved to ${moved.first}, not ${expected}`);
    await page.keyboard.press("z");
    assert.ok(Math.abs((await axis(page)).shown - moved.shown / 2) < 1e-6, "z shows half as much");
    await page.keyboard.press("]");
    assert.ok((await axis(page)).first > moved.first);
    await page.keyboard.press("0");
    assert.deepEqual(await axis(page), { first: 0, shown: 1000, ticks: 1000 });
  });
});

test("two fingers zoom the plots", async () => {
  await withPage("jump.html", { hasTouch: true }, async (page) => {
    const box = await page.locator("aside figure canvas").first().boundingBox(), y = box.y + 40, middle = box.x + 180;
    const session = await page.context().newCDPSession(page);
    const touch = (type, apart) => session.send("Input.dispatchTouchEvent", { type, touchPoints: apart === null ? [] : [{ x: middle - apart, y, id: 0 }, { x: middle + apart, y, id: 1 }] });
    await touch("touchStart", 20);
    for (let apart = 24; apart <= 80; apart += 4) await touch("touchMove", apart);
    await touch("touchEnd", null);
    const { shown } = await axis(page);
    assert.ok(shown > 200 && shown < 330, `${shown} ticks after fingers went from 40 to 160 pixels apart`);
  });
});

test("one frame interval is shown, and the window follows the time", async () => {
  await withPage("jump.html", {}, async (page) => {
    await goTo(page, 500);
    await page.keyboard.press("f");
    const { first, shown } = await axis(page);
    const [begin, end] = await page.evaluate(() => {
      const { frames } = window.remoteTouch.plots.axis;
      return [frames.findLast((tick) => tick <= 500), frames.find((tick) => tick > 500)];
    });
    assert.ok(end - begin === 33 || end - begin === 34, `the frame is in use for ${end - begin} ticks`);
    assert.ok(first <= begin && first + shown >= end && shown < 2 * (end - begin), `${shown} ticks from ${first}`);
    await goTo(page, 900);
    const after = await axis(page);
    assert.ok(after.first <= 900 && after.first + after.shown > 900 && after.shown === shown);
  });
});

test("the values under the pointer are those of the columns, with components", async () => {
  await withPage("jump.html", { viewport: { width: 1280, height: 900 } }, async (page) => {
    const canvas = page.locator("aside figure canvas").nth(1), box = await canvas.boundingBox();
    await page.mouse.move(box.x + 250, box.y + 40);
    await page.waitForSelector("aside figcaption em");
    const captions = await page.locator("aside figcaption").allTextContents(), at = Number(/tick (\d+),/.exec(captions[1])[1]);
    assert.ok(Math.abs(at - (190 / (box.width - 61)) * 999) < 1, `tick ${at}`);
    const force = await page.evaluate((t) => window.remoteTouch.runs[0].vector("force", t), at);
    const shown = [...captions[1].matchAll(/force [xyz] (-?[\d.e-]+) N/g)].map((found) => Number(found[1]));
    assert.deepEqual(shown, force.map((f) => Number(f.toPrecision(4))));
    assert.match(captions[0], new RegExp(`^force ${String(Number(Math.hypot(...force).toPrecision(4))).replace(".", "\\.")} N`));
    await page.mouse.move(10, 300);
    await page.waitForSelector("aside figcaption em", { state: "detached" });
  });
});

// The work for a picture does not grow with the ticks. The time is printed only: it depends on the machine.
test("plots of 15 000 ticks draw at most two lines a column of pixels", async () => {
  await withPage("long.html", {}, async (page) => {
    assert.equal((await axis(page)).ticks, 15000);
    const [mostLines, width, ms] = await page.evaluate(() => new Promise((done) => {
      let lines = 0, most = 0, pictures = 0;
      const drawn = CanvasRenderingContext2D.prototype.lineTo;
      CanvasRenderingContext2D.prototype.lineTo = function (...place) {
        ++lines;
        return drawn.apply(this, place);
      };
      const begin = performance.now();
      const next = () => {
        most = Math.max(most, lines);
        lines = 0;
        if (pictures++ === 20) {
          CanvasRenderingContext2D.prototype.lineTo = drawn;
          const plots = [...document.querySelectorAll("figure canvas")];
          done([most, plots.reduce((sum, plot) => sum + plot.clientWidth, 0), (performance.now() - begin) / 20]);
          return;
        }
        window.remoteTouch.plots.axis.zoom(pictures < 10 ? 0.95 : 1 / 0.95, 7000);
        requestAnimationFrame(next);
      };
      next();
    }));
    console.log(`zooming plots of 15 000 ticks: ${ms.toFixed(1)} ms a picture`);
    assert.ok(mostLines > width && mostLines < 10 * width, `${mostLines} lines on plots that are ${width} pixels wide together`);
  });
});

test("a line leads from the proxy to the nearest point", async () => {
  await withPage("jump.html", {}, async (page) => {
    for (const t of [200, 500, 900]) {
      await goTo(page, t);
      const [longMm, nearestMm] = await page.evaluate(() => {
        const { scene, runs, player } = window.remoteTouch, ends = scene.cue.line.geometry.getAttribute("position").array;
        return [Math.hypot(ends[3] - ends[0], ends[4] - ends[1], ends[5] - ends[2]), 1000 * runs[0].column("nearest_distance").value(player.tick)];
      });
      assert.ok(Math.abs(longMm - nearestMm) < 0.05, `tick ${t}: the line is ${longMm} mm long, the nearest point is ${nearestMm} mm away`);
    }
  });
});

test("space on a focused button does only what the button does", async () => {
  await withPage("jump.html", {}, async (page) => {
    await page.locator("button", { hasText: "One frame" }).focus();
    await page.keyboard.press(" ");
    assert.equal(await page.evaluate(() => window.remoteTouch.player.playing), false);
    assert.ok((await axis(page)).shown < 60, "the button has acted");
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press(" ");
    assert.equal(await page.evaluate(() => window.remoteTouch.player.playing), true);
  });
});

test("every canvas has a name", async () => {
  await withPage("jump.html", {}, async (page) => {
    const names = await page.locator("canvas").evaluateAll((all) => all.map((one) => `${one.getAttribute("role")}: ${one.getAttribute("aria-label")}`));
    assert.ok(names.length >= 5);
    assert.equal(new Set(names).size, names.length, names.join("\n"));
    for (const name of names) assert.match(name, /^img: \w+/);
  });
});

test("a swipe over the picture of a phone scrolls the page", async () => {
  await withPage("jump.html", { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true }, async (page) => {
    const session = await page.context().newCDPSession(page), touch = (type, y) =>
      session.send("Input.dispatchTouchEvent", { type, touchPoints: y === null ? [] : [{ x: 200, y }] });
    await touch("touchStart", 450);
    for (let y = 430; y >= 150; y -= 20) await touch("touchMove", y);
    await touch("touchEnd", null);
    await page.waitForFunction(() => window.scrollY > 100);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 390);
  });
});

test("the plots follow the colour scheme", async () => {
  await withPage("jump.html", { colorScheme: "light" }, async (page) => {
    const dot = () => page.locator("aside figcaption span").first().evaluate((one) => one.style.getPropertyValue("--dot"));
    const light = await dot();
    await page.emulateMedia({ colorScheme: "dark" });
    await page.waitForFunction((before) => document.querySelector("aside figcaption span").style.getPropertyValue("--dot") !== before, light);
  });
});

async function saved(page, what) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(`text=${what}`)]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

test("picture and plots are saved as PNG and SVG", async () => {
  await withPage("jump.html", {}, async (page) => {
    await goTo(page, 700);
    const picture = await saved(page, "Save picture"), plots = await saved(page, "Save plots");
    assert.equal(picture.name, "jump-tick-700.png");
    assert.equal(picture.bytes.subarray(1, 4).toString(), "PNG");
    const size = await page.evaluate(() => [document.querySelector(".picture canvas").width, document.querySelector(".picture canvas").height]);
    assert.deepEqual([picture.bytes.readUInt32BE(16), picture.bytes.readUInt32BE(20)], size);
    assert.equal(plots.name, "jump-tick-700.svg");
    const [root, groups, texts, paths] = await page.evaluate((text) => {
      const svg = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
      return [svg.tagName, svg.querySelectorAll("g").length, [...svg.querySelectorAll("text")].map((one) => one.textContent), svg.querySelectorAll("path").length];
    }, plots.bytes.toString());
    assert.equal(root, "svg");
    assert.equal(groups, await page.locator("aside figure").count());
    assert.ok(texts.some((text) => /force x \(N\).*force y \(N\)/.test(text)), texts.join("\n"));
    assert.ok(paths > 3 * groups, `${paths} lines`);
    assert.ok(plots.bytes.toString().includes(`fill="${colours["force jump"].light}"`), "the mark of the largest change of the force");
  });
});
