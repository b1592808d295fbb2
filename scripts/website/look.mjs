// Opens pages of the site as files, on a telephone and on a wide screen, and prints what is wrong with them: errors of scripts,
// requests that leave the folder, pages wider than the window, a search that finds nothing.
// Usage: node look.mjs CHROMIUM SITE PAGE...      exit code 1: something is wrong
import { pathToFileURL } from "node:url";
import { openBrowser, patience } from "./browser.mjs";

const [chromium, site, ...pages] = process.argv.slice(2), browser = await openBrowser(chromium), home = pathToFileURL(`${site}/`).href;
let wrong = 0;
const complain = (page, words) => {
  wrong += 1;
  console.log(`${page}: ${words}`);
};
for (const width of [390, 1440]) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme: width < 1000 ? "light" : "dark" });
  context.setDefaultTimeout(patience);
  for (const name of pages) {
    const page = await context.newPage();
    page.on("console", (message) => { if (message.type() === "error") complain(name, message.text()); });
    page.on("pageerror", (error) => complain(name, String(error)));
    page.on("request", (request) => {
      if (!request.url().startsWith(home) && !/^(data|blob):/.test(request.url())) complain(name, `asks for ${request.url()}`);
    });
    await page.goto(home + name);
    if (name.includes("?q=")) {
      await page.waitForSelector("#search-results li a").catch(() => complain(name, "finds nothing"));
    }
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    if (wide > 0) complain(name, `${wide} pixels wider than a window of ${width}`);
    await page.close();
  }
  await context.close();
}
await browser.close();
process.exit(wrong ? 1 : 0);
