// A page in headless Chromium with WebGL by software; whatever goes wrong in it is an error.
import assert from "node:assert/strict";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const patience = 600000; // ms: only ends a test that hangs
const software = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

export async function openBrowser(executablePath, args = software) {
  return chromium.launch({ executablePath, args: ["--no-sandbox", "--hide-scrollbars", ...args], timeout: patience });
}

// A page that is ready, with everything that it complained about or asked from a network. hash: of its address.
export async function openPage(browser, file, options = {}, hash = "") {
  const context = await browser.newContext({ viewport: { width: 960, height: 540 }, ...options });
  context.setDefaultTimeout(patience);
  const page = await context.newPage(), complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !message.text().includes("GPU stall")) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`asked for ${request.url()}`);
  });
  const begin = performance.now();
  await page.goto(pathToFileURL(file).href + hash);
  await page.waitForSelector("body[data-ready=yes]");
  await page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); }));
  const firstPictureS = (performance.now() - begin) / 1000;
  return { page, context, complaints, firstPictureS };
}

// How many pixels of the picture have another colour than most, and a hash of all.
export async function picture(page) {
  return page.evaluate(() => {
    window.remoteTouch.scene?.draw();
    const canvas = document.querySelector(".picture canvas"), copy = document.createElement("canvas");
    copy.width = canvas.width;
    copy.height = canvas.height;
    const pen = copy.getContext("2d");
    pen.drawImage(canvas, 0, 0);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height), counts = new Map();
    let hash = 0;
    for (let i = 0; i < data.length; i += 4) {
      const colour = data[i] | (data[i + 1] << 8) | (data[i + 2] << 16);
      counts.set(colour, (counts.get(colour) ?? 0) + 1);
      hash = (Math.imul(hash, 31) + colour) | 0;
    }
    return { drawn: data.length / 4 - Math.max(...counts.values()), hash };
  });
}

export const tick = (page) => page.evaluate(() => window.remoteTouch.player.tick);

export async function goTo(page, to) {
  await page.evaluate((t) => { window.remoteTouch.player.step(t - window.remoteTouch.player.tick); }, to);
}

export function noComplaints(opened, what) {
  assert.deepEqual(opened.complaints, [], `${what}: errors and warnings in the browser`);
}
