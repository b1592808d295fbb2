// Hand, proxy or tool, force, normal, velocity estimate, slave command and guidance goal of one run. Millimetres.
import * as THREE from "three";
import { colours } from "./colours";
import type { Run, Vector } from "./data";

const wayS = 0.3;
// The longest arrow of a force or a velocity, as a part of the scene; that of a greater one is no longer.
export const longestArrow = 0.3;
// The arrow of a velocity of 1 m/s, mm: how far the surface moves in 1/15 s.
export const mmPerMetreASecond = 1000 / 15;

export function ball(radius: number, colour: string, opacity = 1): THREE.Mesh {
  return new THREE.Mesh(new THREE.SphereGeometry(radius, 32, 20),
    new THREE.MeshStandardMaterial({ color: colour, transparent: opacity < 1, opacity, depthWrite: opacity === 1 }));
}

// The mesh of the tool of a run; empty without one.
export function toolMesh(run: Run, colour: string, opacity: number): THREE.Mesh {
  const stored = run.stored.tool, geometry = new THREE.BufferGeometry();
  if (stored) {
    const places = Float32Array.from(run.numbers(stored.vertices), (x) => 1000 * x);
    geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
    geometry.setIndex(new THREE.BufferAttribute(run.numbers(stored.triangles) as Uint32Array, 1));
  }
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  return new THREE.Mesh(flat, new THREE.MeshStandardMaterial({
    color: colour, transparent: true, opacity, side: THREE.DoubleSide, depthWrite: opacity > 0.5,
  }));
}

export function turn(object: THREE.Object3D, run: Run, orientation: string, tick: number): void {
  const [w, x, y, z] = run.rotation(orientation, tick);
  object.quaternion.set(x, y, z, w);
}

function isKnown(v: Vector): boolean {
  return v.every(Number.isFinite);
}

// Returns where the proxy was in the last wayS. It joins known places: a tick without one is left out.
export function wayTo(run: Run, tick: number): Vector[] {
  const first = Math.max(0, tick - Math.round(wayS * run.stored.haptic_rate_hz)), points: Vector[] = [];
  for (let i = first; i <= tick; ++i) points.push(run.vector("proxy_position", i));
  return points.filter(isKnown);
}

const upwards = new THREE.Vector3(0, 1, 0);

// An arrow whose length and direction change. head: its length, mm.
export class Arrow {
  readonly object = new THREE.Group();
  private readonly shaft: THREE.Mesh;
  private readonly tip: THREE.Mesh;
  // always: seen also through what is before it.
  constructor(colour: string, private readonly head: number, private readonly longest = Number.POSITIVE_INFINITY, always = false) {
    const material = new THREE.MeshStandardMaterial({ color: colour, emissive: colour, emissiveIntensity: 0.35, depthTest: !always,
      transparent: always }); // it is drawn after the translucent things, which would tint it
    this.shaft = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 10).translate(0, 0.5, 0), material);
    this.tip = new THREE.Mesh(new THREE.ConeGeometry(1, 1, 16).translate(0, 0.5, 0), material);
    this.object.add(this.shaft, this.tip);
    if (always) this.shaft.renderOrder = this.tip.renderOrder = 5;
  }
  show(from: Vector, vector: Vector, factor: number): void {
    const v = new THREE.Vector3(...vector).multiplyScalar(factor), length = Math.min(v.length(), this.longest);
    this.object.visible = isKnown(from) && length > 1e-3;
    if (!this.object.visible) return;
    this.object.position.set(1000 * from[0], 1000 * from[1], 1000 * from[2]);
    this.object.quaternion.setFromUnitVectors(upwards, v.normalize());
    const head = Math.min(this.head, 0.5 * length), thick = 0.09 * head;
    this.shaft.scale.set(thick, length - head, thick);
    this.tip.scale.set(0.32 * head, head, 0.32 * head);
    this.tip.position.y = length - head;
  }
}

export class HandView {
  readonly object = new THREE.Group();
  private readonly hip: THREE.Mesh;
  private readonly slave: THREE.Mesh;
  private readonly goal: THREE.Mesh;
  private readonly proxy: THREE.Object3D;
  private readonly ghost: THREE.Object3D | null;
  private readonly spheres: THREE.InstancedMesh | null;
  private readonly force: Arrow;
  private readonly normal: Arrow;
  private readonly velocity: Arrow;
  private readonly spring: THREE.Line;
  private readonly way: THREE.Line;

  // sizeMm: of the scene. mmPerN: length of the force's arrow.
  constructor(private readonly run: Run, sizeMm: number, private readonly mmPerN: number, private readonly second: boolean) {
    const dot = 0.008 * sizeMm, head = 0.03 * sizeMm;
    const hipColour = second ? colours.second : colours.hip, proxyColour = second ? colours.second : colours.proxy;
    this.hip = ball(dot, hipColour);
    this.slave = ball(0.8 * dot, colours.slave);
    this.goal = ball(1.5 * dot, colours.guidance, 0.5);
    this.proxy = run.stored.tool ? toolMesh(run, proxyColour, second ? 0.45 : 0.8)
      : ball(1000 * run.stored.contact_radius_m || dot, proxyColour, second ? 0.4 : 0.5);
    this.ghost = run.stored.tool ? toolMesh(run, hipColour, 0.18) : null;
    this.spheres = this.toolSpheres();
    if (this.spheres) this.proxy.add(this.spheres);
    this.force = new Arrow(colours.force, 1.3 * head, longestArrow * sizeMm, true);
    this.normal = new Arrow(colours.normal, head);
    this.velocity = new Arrow(colours.estimate, head, longestArrow * sizeMm);
    this.spring = this.line(hipColour, 2);
    this.way = this.line(proxyColour, Math.round(wayS * run.stored.haptic_rate_hz) + 1);
    const parts = [this.hip, this.slave, this.goal, this.proxy, this.spring, this.way, this.force.object,
      this.normal.object, this.velocity.object];
    if (this.ghost) parts.push(this.ghost);
    this.object.add(...parts);
    this.proxy.renderOrder = 1; // before the forbidden regions, which may be in front of it
  }

  show(tick: number): void {
    const hip = this.run.vector("hip_position", tick), proxy = this.run.vector("proxy_position", tick),
      slave = this.run.vector("slave_command", tick);
    this.place(this.hip, hip);
    this.place(this.proxy, proxy);
    this.place(this.goal, this.run.vector("guidance_goal", tick));
    this.place(this.slave, slave.every((x, k) => x === proxy[k]) ? [Number.NaN, 0, 0] : slave);
    if (this.run.stored.tool) this.turnTools(hip, tick);
    this.force.show(hip, this.run.vector(this.run.forceName, tick), this.mmPerN);
    const normal = this.run.vector("normal", tick), radius = 1000 * this.run.contactRadiusM || 5;
    if (!this.run.stored.tool && this.run.contactRadiusM > 0) this.proxy.scale.setScalar(this.run.contactRadiusM / this.run.stored.contact_radius_m);
    const away: Vector = [0, 1, 2].map((k) => proxy[k] + (radius / 1000) * normal[k]) as Vector;
    this.normal.show(away, normal, 2 * radius);
    const speed = this.run.column("surface_velocity").value(tick);
    this.velocity.show(proxy, normal.map((n) => n * speed) as Vector, mmPerMetreASecond);
    this.setLine(this.spring, [hip, proxy]);
    this.showWay(tick);
  }

  set spheresVisible(visible: boolean) {
    if (this.spheres) this.spheres.visible = visible;
  }

  // The leaves of its sphere tree; hidden at first.
  private toolSpheres(): THREE.InstancedMesh | null {
    const packed = this.run.stored.tool?.spheres;
    if (!packed) return null;
    const numbers = this.run.numbers(packed), count = numbers.length / 4, matrix = new THREE.Matrix4();
    const spheres = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 14, 9),
      new THREE.MeshStandardMaterial({ color: colours.slave, transparent: true, opacity: 0.45, depthWrite: false }), count);
    for (let i = 0; i < count; ++i) {
      const [x, y, z, r] = [0, 1, 2, 3].map((k) => 1000 * numbers[4 * i + k]);
      spheres.setMatrixAt(i, matrix.makeScale(r, r, r).setPosition(x, y, z));
    }
    spheres.visible = false;
    spheres.frustumCulled = false;
    return spheres;
  }
  private turnTools(hip: Vector, tick: number): void {
    turn(this.proxy, this.run, "tool_orientation", tick);
    if (!this.ghost) return;
    turn(this.ghost, this.run, "hip_orientation", tick);
    this.place(this.ghost, hip);
  }
  private place(object: THREE.Object3D, at: Vector): void {
    object.visible = isKnown(at);
    if (object.visible) object.position.set(1000 * at[0], 1000 * at[1], 1000 * at[2]);
  }
  private line(colour: string, points: number): THREE.Line {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * points), 3));
    const line = new THREE.Line(geometry, this.second ? new THREE.LineDashedMaterial({ color: colour })
      : new THREE.LineBasicMaterial({ color: colour }));
    line.frustumCulled = false;
    return line;
  }
  private setLine(line: THREE.Line, points: Vector[]): void {
    const places = line.geometry.getAttribute("position") as THREE.BufferAttribute;
    points.forEach((p, i) => { places.setXYZ(i, 1000 * p[0], 1000 * p[1], 1000 * p[2]); });
    places.needsUpdate = true;
    line.geometry.setDrawRange(0, points.length);
  }
  private showWay(tick: number): void {
    this.setLine(this.way, wayTo(this.run, tick));
  }
}
