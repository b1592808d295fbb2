// The meshes of the true surface, each at its pose: translucent, with their sharp edges as lines. Millimetres.
import * as THREE from "three";
import { colours } from "./colours";
import type { Run, StoredMesh } from "./data";

const sharpDeg = 35; // an edge between two triangles at this angle or more is drawn

// Returns the index of the last of the times that is not after `time`, or 0. times: ascending.
export function indexAt(times: Float64Array, time: number): number {
  let low = 0, high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return low;
}

// A mesh hides what is behind its front side, as forbidden regions do (see CloudView); a sheet that is seen from behind hides
// nothing. It tints the points behind it, and not those before it.
class MeshView {
  readonly object = new THREE.Group();
  private readonly times: Float64Array;
  private readonly poses: Float32Array;

  constructor(run: Run, stored: StoredMesh) {
    this.object.name = stored.name;
    this.times = run.numbers(stored.time_s) as Float64Array;
    this.poses = run.numbers(stored.poses) as Float32Array;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(run.numbers(stored.vertices), 3));
    geometry.setIndex(new THREE.BufferAttribute(run.numbers(stored.triangles), 1));
    const transparent = true;
    const nearest = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({
      colorWrite: false, transparent, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    }));
    const tint = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({
      color: colours.truth, transparent, opacity: 0.35, side: THREE.DoubleSide, depthWrite: false, flatShading: true,
    }));
    const edges = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, sharpDeg),
      new THREE.LineBasicMaterial({ color: colours.truth, transparent, depthWrite: false }));
    const { low_m: low, step_m: step } = stored;
    [nearest, tint, edges].forEach((part, i) => {
      part.position.set(1000 * low[0], 1000 * low[1], 1000 * low[2]);
      part.scale.setScalar(1000 * step);
      part.renderOrder = 2 + i;
      this.object.add(part);
    });
  }
  show(time: number): void {
    const at = 7 * indexAt(this.times, time), [x, y, z, qw, qx, qy, qz] = this.poses.subarray(at, at + 7);
    this.object.visible = Number.isFinite(x); // NaN: the pose is not known
    if (!this.object.visible) return;
    this.object.position.set(1000 * x, 1000 * y, 1000 * z);
    this.object.quaternion.set(qx, qy, qz, qw);
  }
}

export class TrueMeshesView {
  readonly object = new THREE.Group();
  private readonly meshes: MeshView[];

  constructor(private readonly run: Run) {
    this.meshes = (run.stored.true_meshes ?? []).map((stored) => new MeshView(run, stored));
    for (const mesh of this.meshes) this.object.add(mesh.object);
  }
  show(tick: number): void {
    if (this.meshes.length === 0) return;
    const time = this.run.column("time").value(tick);
    for (const mesh of this.meshes) mesh.show(time);
  }
}
