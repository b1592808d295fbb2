// Points that change with every frame, in memory of the graphics processor that is asked for once: four numbers for each
// position and each colour, because others would be copied before every picture.
import * as THREE from "three";

// A step with which all of count places are visited once, and any first part of the visits is spread over all of them.
function spreadingStep(count: number): number {
  const common = (a: number, b: number): number => (b === 0 ? a : common(b, a % b));
  let step = Math.max(Math.round(0.618 * count), 1);
  while (common(step, count) > 1) ++step;
  return step;
}

export class PointsBuffer {
  readonly geometry = new THREE.BufferGeometry();
  private capacity = 0;
  private positions = new Uint16Array();
  private colours = new Uint8Array();

  private all = 0;
  private share = 1;

  // Points that are drawn.
  get count(): number {
    return Math.ceil(this.share * this.all);
  }
  // Draws that fraction of the points, spread evenly.
  setShare(share: number): void {
    this.share = share;
    this.geometry.setDrawRange(0, this.count);
  }

  // positions and colours: three numbers for each point.
  set(positions: Uint16Array, colours: Uint8Array): void {
    const count = positions.length / 3;
    if (count > this.capacity || this.capacity === 0) this.grow(Math.max(Math.ceil(1.2 * count), 16));
    const step = count > 0 ? spreadingStep(count) : 1;
    for (let i = 0, from = 0, m = 0; i < count; ++i, from = (from + step) % count, m += 4) {
      const k = 3 * from;
      this.positions[m] = positions[k];
      this.positions[m + 1] = positions[k + 1];
      this.positions[m + 2] = positions[k + 2];
      this.colours[m] = colours[k];
      this.colours[m + 1] = colours[k + 1];
      this.colours[m + 2] = colours[k + 2];
    }
    for (const name of ["position", "color"]) {
      const attribute = this.geometry.getAttribute(name) as THREE.BufferAttribute;
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, 4 * count);
      attribute.needsUpdate = true;
    }
    this.all = count;
    this.geometry.setDrawRange(0, this.count);
  }

  private grow(capacity: number): void {
    this.geometry.dispose();
    this.capacity = capacity;
    this.positions = new Uint16Array(4 * capacity);
    this.colours = new Uint8Array(4 * capacity).fill(255);
    this.geometry.setAttribute("position", new THREE.BufferAttribute(this.positions, 4).setUsage(THREE.DynamicDrawUsage));
    this.geometry.setAttribute("color", new THREE.BufferAttribute(this.colours, 4, true).setUsage(THREE.DynamicDrawUsage));
  }
}
