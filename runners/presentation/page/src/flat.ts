// Draws the scene without WebGL 2: from the side, x to the right and y up.
import { colours } from "./colours";
import { round125, type Run, type Vector } from "./data";
import { longestArrow } from "./hand";
import { fullForce, largestForce } from "./scene";

export class FlatView {
  readonly mmPerN: number;
  readonly longestMm: number; // of the arrow of a force

  constructor(private readonly canvas: HTMLCanvasElement, private readonly runs: Run[]) {
    const { low_m: low, high_m: high } = runs[0].stored, sizeMm = Math.max(1000 * Math.hypot(...high.map((x, k) => x - low[k])), 1);
    this.mmPerN = (fullForce * sizeMm) / Math.max(largestForce(runs), 1e-9);
    this.longestMm = longestArrow * sizeMm;
  }

  show(tick: number): void {
    const { clientWidth: width, clientHeight: height } = this.canvas, ratio = window.devicePixelRatio;
    const pen = this.canvas.getContext("2d", { willReadFrequently: true });
    if (width === 0 || height === 0 || !pen) return;
    this.canvas.width = ratio * width;
    this.canvas.height = ratio * height;
    pen.scale(ratio, ratio);
    const { low_m: low, high_m: high } = this.runs[0].stored;
    const factor = Math.min(width / (high[0] - low[0]), height / (high[1] - low[1]));
    const at = (p: Vector): [number, number] =>
      [width / 2 + (p[0] - (low[0] + high[0]) / 2) * factor, height / 2 - (p[1] - (low[1] + high[1]) / 2) * factor];
    const frame = this.runs[0].frameAt(this.runs[0].known(tick));
    pen.fillStyle = "#8888";
    for (let i = 0; frame && i < frame.positions.length / 3; ++i) {
      const [x, y] = at(this.runs[0].point(frame, i));
      pen.fillRect(x - 1, y - 1, 2, 2);
    }
    this.drawHands(pen, tick, factor, at);
    this.drawBar(pen, factor, height);
  }

  private drawHands(pen: CanvasRenderingContext2D, tick: number, factor: number, at: (p: Vector) => [number, number]): void {
    const dot = (p: Vector, radius: number, colour: string) => {
      pen.fillStyle = colour;
      pen.beginPath();
      pen.arc(...at(p), radius, 0, 2 * Math.PI);
      pen.fill();
    };
    for (const run of this.runs) {
      const t = run.known(tick), hip = run.vector("hip_position", t), force = run.vector(run.forceName, t);
      dot(run.vector("proxy_position", t), Math.max(factor * run.contactRadiusM, 4), `${colours.proxy}88`);
      if (run.slaveRadiusM > 0) dot(run.vector("slave_position", t), Math.max(factor * run.slaveRadiusM, 4), `${colours.robot}88`);
      dot(hip, 4, colours.hip);
      const size = Math.hypot(force[0], force[1]), mPerN = Math.min(this.mmPerN, this.longestMm / size) / 1000;
      if (!(size > 0)) continue;
      pen.strokeStyle = colours.force;
      pen.lineWidth = 2;
      pen.beginPath();
      pen.moveTo(...at(hip));
      pen.lineTo(...at([hip[0] + mPerN * force[0], hip[1] + mPerN * force[1], 0]));
      pen.stroke();
    }
  }
  private drawBar(pen: CanvasRenderingContext2D, factor: number, height: number): void {
    const mm = round125((120 / factor) * 1000);
    pen.fillStyle = "#eee";
    pen.fillRect(14, height - 14, (mm / 1000) * factor, 2);
    pen.fillText(`${mm} mm`, 14, height - 20);
  }
}
