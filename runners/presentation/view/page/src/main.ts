// A page of one or two traces, of a sweep with some of its runs, or of a live run.
import { readView, type Sweep } from "./data";
import { showLive } from "./live_page";
import { showRuns } from "./run_page";
import { SweepMap } from "./sweep_map";

type Shown = ReturnType<typeof showRuns>;

async function start(): Promise<void> {
  const { runs, sweep, live, buffer } = await readView();
  if (live) {
    showLive(live, buffer);
    return;
  }
  const publish = (shown: Shown, of = runs) => {
    // For scripts and tests.
    Object.assign(window, { remoteTouch: { player: shown.player, scene: shown.scene, runs: of, sweep } });
    document.body.dataset.ready = "yes";
  };
  if (!sweep) {
    publish(showRuns(runs, null));
    return;
  }
  let now: Shown | null = null;
  const show = (of: Sweep, run: number) => {
    now?.end();
    const map = new SweepMap(of, run, (chosen) => show(of, chosen));
    now = showRuns([runs[run]], map.element, `${of.stored.title || of.stored.file}: ${of.text(of.cellOf(run))}`);
    publish(now, [runs[run]]);
  };
  show(sweep, 0);
}

start().catch((error: Error) => {
  document.body.textContent = `This page cannot be shown: ${error.message}`;
});
