// The points of the frame in use, those that touch, and the forbidden regions around them. Millimetres.
import * as THREE from "three";
import { colours, heights, rampColour } from "./colours";
import type { Frame, Run, Vector } from "./data";
import { PointsBuffer } from "./points_buffer";

const maxRegions = 3000;
const regionSpacing = 0.2; // of the radius: of regions of about one radius in a cube of this size one is drawn

// Of the heights, in the numbers of positions.
function rangeOf(all: Uint16Array[]): [number, number] {
  let low = 65535, high = 0;
  for (const positions of all)
    for (let i = 1; i < positions.length; i += 3) {
      low = Math.min(low, positions[i]);
      high = Math.max(high, positions[i]);
    }
  return [low, Math.max(high, low + 1)];
}

function everyNth(list: number[], max: number): number[] {
  const every = Math.max(Math.ceil(list.length / max), 1);
  return every === 1 ? list : list.filter((_, i) => i % every === 0);
}

// The same for regions that nearly coincide. m
export function regionKey(place: Vector, radius: number): string {
  const size = Math.round(Math.log(radius) / Math.log(1 + regionSpacing)), cube = regionSpacing * (1 + regionSpacing) ** size;
  return [size, ...place.map((x) => Math.floor(x / cube))].join();
}

export class CloudView {
  readonly object = new THREE.Group();
  touching = 0;
  private readonly buffer = new PointsBuffer();
  private readonly points: THREE.Points;
  private readonly nearHand = new PointsBuffer(); // all points near the hand, where only some of the others are drawn
  private tinted: Uint8Array = new Uint8Array();
  private readonly near: THREE.Points;
  private readonly regions: THREE.InstancedMesh;
  private readonly tint: THREE.InstancedMesh;
  private share = 1; // that is drawn
  private nearPlaces = new Float32Array();
  private shown: Frame | undefined;
  private readonly heightRange: [number, number] | null; // null: of each frame its own

  constructor(private readonly run: Run, pointMm: number) {
    this.points = new THREE.Points(this.buffer.geometry,
      new THREE.PointsMaterial({ size: pointMm, vertexColors: true }));
    const nearHand = new THREE.Points(this.nearHand.geometry, this.points.material);
    nearHand.frustumCulled = false;
    this.points.add(nearHand);
    this.near = new THREE.Points(new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ size: 2.6 * pointMm, color: colours.touching }));
    // Thousands of balls that overlap would hide everything behind them. Only their nearest surface is drawn: the first
    // pass finds how far away that is, the second one gives it a colour.
    const ball = new THREE.IcosahedronGeometry(1, 1);
    this.regions = new THREE.InstancedMesh(ball, new THREE.MeshBasicMaterial({ colorWrite: false, transparent: true }), maxRegions);
    this.tint = new THREE.InstancedMesh(ball, new THREE.MeshLambertMaterial({
      color: colours.fixture, transparent: true, opacity: 0.3, depthWrite: false,
    }), maxRegions);
    this.tint.instanceMatrix = this.regions.instanceMatrix;
    this.regions.renderOrder = 2;
    this.tint.renderOrder = 3;
    this.regions.count = this.tint.count = 0;
    for (const part of [this.points, this.near, this.regions, this.tint]) {
      part.frustumCulled = false;
      this.object.add(part);
    }
    const frames = [...run.frames.values()];
    this.makeRoom(50);
    this.heightRange = frames.length > 0 ? rangeOf(frames.map((frame) => frame.positions)) : null;
  }

  show(tick: number): void {
    const frame = this.run.frameAt(tick);
    if (frame !== this.shown) this.showFrame(frame);
    this.showTouching(frame, tick);
    this.showNearHand(frame, tick);
  }
  // Points that are drawn near the hand, beside the others.
  get nearHandCount(): number {
    return this.nearHand.count;
  }
  // Points that are drawn.
  pointCount(): number {
    return this.buffer.count;
  }
  setShare(share: number): void {
    this.share = share;
    this.buffer.setShare(share);
  }
  set regionsVisible(visible: boolean) {
    this.regions.visible = this.tint.visible = visible;
  }

  // Positions go to the graphics processor as they came; it scales them.
  private showFrame(frame: Frame | undefined): void {
    this.shown = frame;
    const positions = frame?.positions ?? new Uint16Array(), { low, step } = this.run.grid();
    this.points.position.set(1000 * low[0], 1000 * low[1], 1000 * low[2]);
    this.points.scale.setScalar(1000 * step);
    this.tinted = frame?.colours ?? this.tints(positions);
    this.buffer.set(positions, this.tinted);
    this.showRegions(frame);
  }
  private tints(positions: Uint16Array): Uint8Array {
    const tints = new Uint8Array(positions.length), [low, high] = this.heightRange ?? rangeOf([positions]);
    for (let i = 0; i < positions.length; i += 3) rampColour(heights, (positions[i + 1] - low) / (high - low), tints, i);
    return tints;
  }
  private showRegions(frame: Frame | undefined): void {
    const radii = frame?.fixtureRadiusM;
    this.regions.count = this.tint.count = 0;
    if (!frame || !radii) return;
    const all: number[] = [];
    radii.forEach((radius, i) => { if (radius > 0) all.push(i); });
    const drawn = everyNth(this.apart(frame, radii, everyNth(all, 4 * maxRegions)), maxRegions * this.share), matrix = new THREE.Matrix4();
    for (const at of drawn) {
      const r = 1000 * radii[at], [x, y, z] = this.run.point(frame, at);
      matrix.makeScale(r, r, r).setPosition(1000 * x, 1000 * y, 1000 * z);
      this.regions.setMatrixAt(this.regions.count++, matrix);
    }
    this.tint.count = this.regions.count;
    this.regions.instanceMatrix.needsUpdate = true;
  }
  // Without those that nearly coincide with another: each costs as much to draw as one that is seen.
  private apart(frame: Frame, radii: Float32Array, points: number[]): number[] {
    const taken = new Set<string>();
    return points.filter((i) => {
      const region = regionKey(this.run.point(frame, i), radii[i]);
      return !taken.has(region) && taken.add(region);
    });
  }
  private showTouching(frame: Frame | undefined, tick: number): void {
    const found = frame ? this.run.touching(frame, tick).flatMap((i) => this.run.point(frame, i)) : [];
    this.touching = found.length / 3;
    if (this.touching > this.nearPlaces.length / 3) this.makeRoom(this.touching);
    found.forEach((x, i) => { this.nearPlaces[i] = 1000 * x; });
    this.near.geometry.setDrawRange(0, this.touching);
    this.near.geometry.getAttribute("position").needsUpdate = true;
  }
  private showNearHand(frame: Frame | undefined, tick: number): void {
    const near = frame && this.share < 1 ? this.run.nearHand(frame, tick) : [];
    const three = (from: Uint16Array | Uint8Array) => near.flatMap((i) => [from[3 * i], from[3 * i + 1], from[3 * i + 2]]);
    if (near.length > 0 || this.nearHand.count > 0)
      this.nearHand.set(Uint16Array.from(three(frame?.positions ?? new Uint16Array())), Uint8Array.from(three(this.tinted)));
  }
  private makeRoom(points: number): void {
    this.near.geometry.dispose();
    this.nearPlaces = new Float32Array(6 * points);
    this.near.geometry.setAttribute("position", new THREE.BufferAttribute(this.nearPlaces, 3));
  }
}
