// Where there is no WebGL 2: the scene from the side, x to the right and y up.
import { colours } from "./colours";
import { round125, type Run, type Vector } from "./data";

export class FlatView {
  constructor(private readonly canvas: HTMLCanvasElement, private readonly runs: Run[]) {}

  show(tick: number): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.canvas.width = width;
    this.canvas.height = height;
    const pen = this.canvas.getContext("2d");
    if (!pen) return;
    const { low_m: low, high_m: high } = this.runs[0].stored;
    const factor = Math.min(width / (high[0] - low[0]), height / (high[1] - low[1]));
    const at = (p: Vector): [number, number] =>
      [width / 2 + (p[0] - (low[0] + high[0]) / 2) * factor, height / 2 - (p[1] - (low[1] + high[1]) / 2) * factor];
    const dot = (p: Vector, radius: number, colour: string) => {
      pen.fillStyle = colour;
      pen.beginPath();
      pen.arc(...at(p), radius, 0, 2 * Math.PI);
      pen.fill();
    };
    const frame = this.runs[0].frameAt(this.runs[0].known(tick));
    if (frame) for (let i = 0; i < frame.positions.length / 3; ++i) dot(this.runs[0].point(frame, i), 1, "#8888");
    for (const run of this.runs) {
      const t = run.known(tick), hip = run.vector("hip_position", t), force = run.vector(run.forceName, t);
      dot(run.vector("proxy_position", t), Math.max(factor * run.contactRadiusM, 4), `${colours.proxy}88`);
      if (run.slaveRadiusM > 0) dot(run.vector("slave_position", t), Math.max(factor * run.slaveRadiusM, 4), `${colours.robot}88`);
      dot(hip, 4, colours.hip);
      pen.strokeStyle = colours.force;
      pen.lineWidth = 2;
      pen.beginPath();
      pen.moveTo(...at(hip));
      pen.lineTo(...at([hip[0] + 0.005 * force[0], hip[1] + 0.005 * force[1], 0]));
      pen.stroke();
    }
    const mm = round125((120 / factor) * 1000);
    pen.fillStyle = "#eee";
    pen.fillRect(14, height - 14, (mm / 1000) * factor, 2);
    pen.fillText(`${mm} mm`, 14, height - 20);
  }
}
