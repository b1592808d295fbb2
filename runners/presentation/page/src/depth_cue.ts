// Shows how far the proxy is from the surface: a line from its centre to the nearest shown point, and a dark disc there
// while the point is outside the proxy. Millimetres.
import * as THREE from "three";
import type { Frame, Run, Vector } from "./data";

const colour = "#f4f4f4";
const lift = 0.1; // parts of the radius by which the disc is nearer to the proxy than the point
const outside = 1.2; // radii: nearer points touch, and the disc would hide them

export class DepthCue {
  readonly object = new THREE.Group();
  private readonly line: THREE.Line;
  private readonly disc: THREE.Mesh;

  constructor(private readonly run: Run, private readonly radiusMm: number) {
    const ends = new THREE.BufferGeometry();
    ends.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6), 3));
    this.line = new THREE.Line(ends, new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity: 0.8 }));
    this.line.frustumCulled = false;
    this.disc = new THREE.Mesh(new THREE.CircleGeometry(radiusMm, 32), new THREE.MeshBasicMaterial({
      color: 0x000000, transparent: true, opacity: 0.6, depthWrite: false, side: THREE.DoubleSide,
    }));
    this.disc.renderOrder = 1; // after the points and the true surface
    this.object.add(this.line, this.disc);
  }

  show(tick: number): void {
    const proxy = this.run.vector("proxy_position", tick), frame = this.run.frameAt(tick);
    const foot = frame && proxy.every(Number.isFinite) ? this.nearest(frame, proxy) : null;
    this.object.visible = foot !== null;
    if (!foot) return;
    const from = new THREE.Vector3(...proxy).multiplyScalar(1000), to = new THREE.Vector3(...foot).multiplyScalar(1000);
    const towards = from.clone().sub(to).normalize(), ends = this.line.geometry.getAttribute("position") as THREE.BufferAttribute;
    ends.setXYZ(0, ...from.toArray());
    ends.setXYZ(1, ...to.toArray());
    ends.needsUpdate = true;
    this.disc.visible = from.distanceTo(to) > outside * this.radiusMm;
    this.disc.position.copy(to).addScaledVector(towards, lift * this.radiusMm);
    this.disc.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), towards);
  }
  private nearest(frame: Frame, to: Vector): Vector | null {
    const { positions: p } = frame, { low, step } = this.run.grid(), [x, y, z] = to.map((c, k) => (c - low[k]) / step);
    let found = -1, least = Number.POSITIVE_INFINITY;
    for (let i = 0; i < p.length; i += 3) {
      const square = (p[i] - x) ** 2 + (p[i + 1] - y) ** 2 + (p[i + 2] - z) ** 2;
      if (square < least) [found, least] = [i / 3, square];
    }
    return found < 0 ? null : this.run.point(frame, found);
  }
}
