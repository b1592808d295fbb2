// Pictures of pages of runs. Usage: node shots.mjs CHROMIUM JOBS.json
// A job has a page, the size of the window, a style that is added, the number of steps of the wheel that bring the scene nearer, a
// selector of what is shown, and pictures: [tick or null, file].
import { readFileSync } from "node:fs";
import { goTo, noComplaints, openBrowser, openPage } from "./browser.mjs";

const [chromium, jobs] = process.argv.slice(2), browser = await openBrowser(chromium);
const drawn = (page) => page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); }));
for (const job of JSON.parse(readFileSync(jobs, "utf8"))) {
  const opened = await openPage(browser, job.page, { viewport: job.size, colorScheme: "dark", bypassCSP: true });
  const { page, context } = opened;
  await page.addStyleTag({ content: job.style });
  if (job.nearer) await page.mouse.move(job.size.width / 2, job.size.height / 2);
  for (let step = 0; step < (job.nearer ?? 0); ++step) await page.mouse.wheel(0, -100);
  for (const [tick, file] of job.pictures) {
    if (tick !== null) await goTo(page, tick);
    await drawn(page);
    await page.locator(job.shown).first().screenshot({ path: file });
  }
  noComplaints(opened, job.page);
  await context.close();
}
await browser.close();
