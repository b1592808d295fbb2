// The slave robot of one run: its ball or tool, the force of the scene on it, and a line to the command that it has
// received. There is nothing before the slave starts, and in a run without one. Millimetres.
import * as THREE from "three";
import { colours } from "./colours";
import type { Run } from "./data";
import { Arrow, ball, longestArrow, toolMesh, turn } from "./hand";

export class SlaveView {
  readonly object = new THREE.Group();
  private readonly shape: THREE.Mesh;
  private readonly force: Arrow;
  private readonly line: THREE.Line;

  // sizeMm: of the scene. mmPerN: length of the force's arrow, as for the force on the hand.
  constructor(private readonly run: Run, sizeMm: number, private readonly mmPerN: number, second: boolean) {
    const colour = second ? colours.second : colours.robot;
    const opacity = second ? 0.4 : 0.6;
    this.shape = this.isTool ? toolMesh(run, colour, opacity) : ball(1000 * run.slaveRadiusM, colour, opacity);
    this.shape.renderOrder = 1; // as the proxy
    this.force = new Arrow(colours.robot, 0.039 * sizeMm, longestArrow * sizeMm, true);
    const ends = new THREE.BufferGeometry();
    ends.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6), 3));
    this.line = new THREE.Line(ends, new THREE.LineBasicMaterial({ color: colour }));
    this.line.frustumCulled = false;
    this.object.add(this.shape, this.force.object, this.line);
  }

  private get isTool(): boolean {
    return this.run.columns.has("slave_orientation");
  }
  show(tick: number): void {
    const at = this.run.vector("slave_position", tick), command = this.run.vector("received_command", tick);
    this.object.visible = at.every(Number.isFinite);
    if (!this.object.visible) return;
    this.shape.position.set(...at).multiplyScalar(1000);
    if (this.isTool) turn(this.shape, this.run, "slave_orientation", tick);
    this.force.show(at, this.run.vector("slave_force", tick), this.mmPerN);
    const ends = this.line.geometry.getAttribute("position") as THREE.BufferAttribute;
    [at, command].forEach((end, i) => { ends.setXYZ(i, 1000 * end[0], 1000 * end[1], 1000 * end[2]); });
    ends.needsUpdate = true;
  }
}
