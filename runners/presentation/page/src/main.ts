// A page of one or two traces, of a sweep with some of its runs, or of a live run.
import { type RunPlace, runIn } from "./address";
import { readView, type Sweep } from "./data";
import { showLive } from "./live_page";
import { type Shown, showRuns } from "./run_page";
import { SweepMap } from "./sweep_map";

async function start(): Promise<void> {
  const { runs, sweep, live, buffer } = await readView();
  if (live) {
    showLive(live, buffer);
    return;
  }
  const publish = (shown: Shown, of = runs) => {
    // For scripts and tests.
    Object.assign(window, { remoteTouch: { player: shown.player, scene: shown.scene, plots: shown.plots, runs: of, sweep } });
    document.body.dataset.ready = "yes";
  };
  if (!sweep) {
    publish(showRuns(runs, null));
    return;
  }
  let now: Shown | null = null, place: RunPlace = runIn(location.hash, runs.length);
  const show = (of: Sweep, run: number) => {
    now?.end();
    place = { run: run + 1, runs: runs.length };
    const map = new SweepMap(of, run, (chosen) => {
      history.replaceState(null, "", "#"); // another run opens at its own event
      show(of, chosen);
    });
    now = showRuns([runs[run]], map.element, `${of.stored.title || of.stored.file}: ${of.text(of.cellOf(run))}`, place);
    publish(now, [runs[run]]);
  };
  show(sweep, place.run - 1);
  window.addEventListener("hashchange", () => {
    const { run } = runIn(location.hash, runs.length);
    if (run !== place.run) show(sweep, run - 1);
  });
}

start().catch((error: Error) => {
  document.body.textContent = `This page cannot be shown: ${error.message}`;
});
