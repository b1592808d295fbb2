// The true surface from which signed_distance is measured, as a translucent sheet. It moves with the time, or stays as it
// was at the last capture. Millimetres.
import * as THREE from "three";
import { colours } from "./colours";
import type { Run } from "./data";

export class TruthView {
  readonly object: THREE.Mesh;
  private readonly heights: Float32Array;
  private readonly times: Float64Array;
  private readonly n: number;
  private shown = -1; // which of the times

  constructor(private readonly run: Run) {
    const truth = run.stored.truth;
    this.n = truth?.columns ?? 0;
    this.heights = truth ? (run.numbers(truth.height_m) as Float32Array) : new Float32Array();
    this.times = truth ? (run.numbers(truth.time_s) as Float64Array) : new Float64Array();
    const geometry = new THREE.BufferGeometry();
    if (truth) {
      geometry.setAttribute("position", new THREE.BufferAttribute(this.corners(), 3));
      geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(6 * (this.n - 1) ** 2), 1));
    }
    this.object = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({
      color: colours.truth, transparent: true, opacity: 0.3, side: THREE.DoubleSide, depthWrite: false,
    }));
    this.object.frustumCulled = false;
    this.object.visible = truth !== undefined;
  }

  get known(): boolean {
    return this.run.stored.truth !== undefined;
  }

  show(tick: number): void {
    if (!this.run.stored.truth) return;
    const time = this.run.column("time").value(tick), size = this.n * this.n, last = this.times.length - 1;
    let i = 0;
    while (i < last && this.times[i + 1] <= time) ++i;
    const next = this.run.stored.truth.stays ? i : Math.min(i + 1, last);
    const part = next > i ? Math.max((time - this.times[i]) / (this.times[next] - this.times[i]), 0) : 0;
    const places = this.object.geometry.getAttribute("position") as THREE.BufferAttribute;
    for (let k = 0; k < size; ++k) {
      const before = this.heights[i * size + k], after = this.heights[next * size + k];
      places.setY(k, Number.isFinite(before + after) ? 1000 * (before + part * (after - before)) : 0);
    }
    if (i !== this.shown) this.setTriangles(i, next);
    this.shown = i;
    places.needsUpdate = true;
    this.object.geometry.computeVertexNormals();
  }

  private corners(): Float32Array {
    const truth = this.run.stored.truth, places = new Float32Array(3 * this.n * this.n);
    if (truth)
      for (let k = 0; k < this.n; ++k)
        for (let i = 0; i < this.n; ++i) {
          const at = 3 * (k * this.n + i), along = (axis: number, j: number) =>
            1000 * (truth.low_m[axis] + ((truth.high_m[axis] - truth.low_m[axis]) * j) / (this.n - 1));
          places[at] = along(0, i);
          places[at + 2] = along(2, k);
        }
    return places;
  }
  // Where the height is known at two of the times.
  private setTriangles(before: number, after: number): void {
    const index = this.object.geometry.getIndex(), size = this.n * this.n;
    if (!index) return;
    let count = 0;
    for (let k = 0; k + 1 < this.n; ++k)
      for (let i = 0; i + 1 < this.n; ++i) {
        const a = k * this.n + i, b = a + this.n;
        if (![a, a + 1, b, b + 1].every((c) => Number.isFinite(this.heights[before * size + c] + this.heights[after * size + c]))) continue;
        for (const corner of [a, b, a + 1, a + 1, b, b + 1]) index.setX(count++, corner);
      }
    index.needsUpdate = true;
    this.object.geometry.setDrawRange(0, count);
  }
}
