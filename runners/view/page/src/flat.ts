// Where there is no WebGL 2: the scene from the side, x to the right and y up.
import { colours } from "./colours";
import type { Run, Vector } from "./data";

export class FlatView {
  private readonly low: [number, number];
  private readonly size: number;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly runs: Run[]) {
    const low: [number, number] = [Number.POSITIVE_INFINITY, Number.POSITIVE_INFINITY], high = [-Infinity, -Infinity];
    for (const run of runs)
      for (const name of ["hip_position", "proxy_position"])
        for (let tick = 0; tick < run.ticks; ++tick)
          run.vector(name, tick).slice(0, 2).forEach((x, k) => {
            if (Number.isFinite(x)) [low[k], high[k]] = [Math.min(low[k], x), Math.max(high[k], x)];
          });
    this.size = Math.max(high[0] - low[0], high[1] - low[1]) + 0.06;
    this.low = [low[0] - 0.03, low[1] - 0.03];
  }

  show(tick: number): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.canvas.width = width;
    this.canvas.height = height;
    const pen = this.canvas.getContext("2d");
    if (!pen) return;
    const factor = Math.min(width, height) / this.size;
    const at = (p: Vector): [number, number] => [(p[0] - this.low[0]) * factor, height - (p[1] - this.low[1]) * factor];
    const dot = (p: Vector, radius: number, colour: string) => {
      pen.fillStyle = colour;
      pen.beginPath();
      pen.arc(...at(p), radius, 0, 2 * Math.PI);
      pen.fill();
    };
    const frame = this.runs[0].frameAt(tick);
    if (frame) for (let i = 0; i < frame.positions.length / 3; ++i) dot(this.runs[0].point(frame, i), 1, "#8888");
    for (const run of this.runs) {
      const t = Math.min(tick, run.ticks - 1), hip = run.vector("hip_position", t), force = run.vector("force", t);
      dot(run.vector("proxy_position", t), Math.max(factor * run.contactRadiusM, 4), `${colours.proxy}88`);
      dot(hip, 4, colours.hip);
      pen.strokeStyle = colours.force;
      pen.lineWidth = 2;
      pen.beginPath();
      pen.moveTo(...at(hip));
      pen.lineTo(...at([hip[0] + 0.005 * force[0], hip[1] + 0.005 * force[1], 0]));
      pen.stroke();
    }
  }
}
