// The 3-D view: camera, lights, scale bar, and what is in it. The scene is in millimetres.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { CloudView } from "./cloud";
import { round125, type Run, type Vector } from "./data";
import { DepthCue } from "./depth_cue";
import { HandView, longestArrow } from "./hand";
import { SlaveView } from "./slave_view";
import { TrueMeshesView } from "./true_meshes";
import { TruthView } from "./truth";
import { acrossForce, distanceOf } from "./viewpoint";

export const fullForce = 0.2; // the arrow of the largest force to expect, as a part of the hand's scale
const radiiOfHand = 38; // the hand's scale in contact radii: the head of the force's arrow is 0.039 of it, at most 1.5 r_c
const leastProxyPx = 30; // how wide the proxy is in the view across the force
const seen = 0.86; // of the picture: what the camera is to see; the rest is for labels
const labelHeight = 0.022; // where the camera sees 0.7 at a distance of 1

export type CameraPreset = "sensor" | "side" | "follow" | "across";

// Returns the largest force on a hand, or, if no hand feels one, on a slave.
export function largestForce(runs: Run[]): number {
  const largest = (nameOf: (run: Run) => string) => {
    let found = 0;
    for (const run of runs) {
      const column = run.columns.get(nameOf(run));
      if (column) for (let tick = 0; tick < run.ticks; ++tick) found = Math.max(found, column.magnitude(tick) || 0);
    }
    return found;
  };
  return largest((run) => run.forceName) || largest(() => "slave_force");
}

// A text that faces the camera, as large from near as from far.
function label(text: string): THREE.Sprite {
  const canvas = document.createElement("canvas"), pixels = 48;
  const pen = canvas.getContext("2d");
  if (!pen) return new THREE.Sprite();
  const font = `${0.75 * pixels}px system-ui, sans-serif`;
  pen.font = font;
  canvas.width = Math.ceil(pen.measureText(text).width) + 8;
  canvas.height = pixels;
  pen.font = font;
  pen.fillStyle = "#ddd";
  pen.textBaseline = "middle";
  pen.fillText(text, 4, pixels / 2);
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false, sizeAttenuation: false }));
  sprite.center.set(-0.05, 0.5); // beside the arrow
  sprite.scale.set((labelHeight * canvas.width) / pixels, labelHeight, 1);
  return sprite;
}

// How far a tool reaches from its centre, mm; 0 without one.
function toolRadius(run: Run): number {
  const vertices = run.stored.tool ? run.numbers(run.stored.tool.vertices) : [];
  let reach = 0;
  for (let i = 0; i + 2 < vertices.length; i += 3) reach = Math.max(reach, Math.hypot(vertices[i], vertices[i + 1], vertices[i + 2]));
  return 1000 * reach;
}

export class SceneView {
  readonly clouds: CloudView[];
  readonly mmPerN: number;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(40, 1, 1, 1e5);
  private readonly controls: OrbitControls;
  private readonly hands: HandView[];
  private readonly slaves: SlaveView[];
  private readonly truths: TruthView[];
  private readonly trueMeshes: TrueMeshesView;
  private readonly cue: DepthCue;
  private readonly labels: THREE.Sprite[] = []; // of the axes
  private readonly middle = new THREE.Vector3();
  private readonly size: number;
  private readonly handSize: number; // the scale of hand and arrows
  private readonly proxyMm: number; // radius of proxy or tool
  private across = false; // the camera sees across the force, and nobody turned it
  private drawing = 0; // the browser's number of the call; 0: none
  private readonly isLive: boolean;
  private tick = 0;
  private follows = false;
  private followed = new THREE.Vector3();

  // Throws where the browser has no WebGL 2.
  // fullN: the largest force to expect in a live run; 0: that of the runs.
  constructor(private readonly canvas: HTMLCanvasElement, private readonly bar: HTMLElement, private readonly runs: Run[],
    fullN = 0) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.isLive = fullN > 0;
    const box = this.actionBox();
    box.getCenter(this.middle);
    this.size = Math.max(box.getSize(new THREE.Vector3()).length(), 1);
    const radius = runs[0].contactRadiusM;
    this.handSize = radius > 0 && !runs[0].stored.tool && !this.isLive ? Math.min(this.size, radiiOfHand * 1000 * radius) : this.size;
    this.proxyMm = toolRadius(runs[0]) || 1000 * radius || 0.008 * this.size;
    this.mmPerN = (fullForce * this.handSize) / Math.max(fullN || largestForce(runs), 1e-9);
    const pointMm = this.handSize < this.size ? 0.35 * this.proxyMm : 0.005 * this.size;
    this.clouds = runs.slice(0, 1).map((run) => new CloudView(run, pointMm));
    this.hands = runs.map((run, i) => new HandView(run, this.handSize, this.mmPerN, i > 0));
    this.slaves = runs.map((run, i) => new SlaveView(run, this.handSize, this.mmPerN, i > 0));
    this.truths = runs.slice(0, 1).map((run) => new TruthView(run));
    this.trueMeshes = new TrueMeshesView(runs[0]);
    this.cue = new DepthCue(runs[0], runs[0].stored.tool ? 0.2 * this.proxyMm : this.proxyMm);
    for (const part of [...this.truths, this.trueMeshes, ...this.clouds, ...this.hands, ...this.slaves, this.cue]) this.scene.add(part.object);
    this.light();
    this.scene.add(this.axes());
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.drawSoon());
    this.controls.addEventListener("start", () => { this.across = false; });
    canvas.role = "img";
    canvas.ariaLabel = "3-D view of points, hand, proxy and force";
    // A finger that moves up or down scrolls the page; two fingers turn and zoom.
    if (!this.isLive) canvas.style.touchAction = "pan-y";
    this.setCamera(runs[0].stored.sensor ? "sensor" : this.goesFar() ? "follow" : "side");
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  // How long an arrow of a force or a velocity is at most, mm.
  get longestMm(): number {
    return longestArrow * this.handSize;
  }
  show(tick: number): void {
    this.tick = tick;
    for (const part of [...this.truths, this.trueMeshes, ...this.clouds, this.cue]) part.show(this.runs[0].known(tick));
    for (const each of [this.hands, this.slaves]) each.forEach((part, i) => { part.show(this.runs[i].known(tick)); });
    if (this.follows) this.followProxy(tick);
    if (this.isLive) this.draw();
    else this.drawSoon();
  }
  setCamera(preset: CameraPreset): void {
    const sensor = this.runs[0].stored.sensor;
    this.across = preset === "across";
    this.follows = preset === "follow" || this.across;
    this.camera.up.set(0, 1, 0);
    const away = new THREE.Vector3(0.35, 0.3, 1);
    if (preset === "sensor" && sensor) {
      this.camera.up.set(...sensor.up);
      away.set(...sensor.forward).multiplyScalar(-1);
    } else if (preset === "sensor") away.set(0, 1, 0.02);
    else if (sensor) away.copy(this.beside(sensor.forward));
    if (this.across) away.copy(this.awayFromForce());
    const far = this.distance(away.normalize());
    this.camera.position.copy(this.middle).addScaledVector(away, this.across ? this.nearDistance() : this.follows ? 0.5 * far : far);
    this.controls.target.copy(this.middle);
    this.followed.copy(this.middle);
    this.camera.near = 0.005 * far;
    this.camera.far = 50 * far;
    if (this.follows) this.followProxy(this.tick);
    this.resize();
    this.controls.update();
  }
  // Turns the camera across the force of this tick, unless the user has chosen another view.
  showEvent(tick: number): void {
    this.tick = tick;
    if (this.across) this.setCamera("across");
  }
  setVisible(what: "points" | "truth" | "regions" | "spheres" | "axes", visible: boolean): void {
    if (what === "spheres") for (const hand of this.hands) hand.spheresVisible = visible;
    else if (what === "regions") for (const cloud of this.clouds) cloud.regionsVisible = visible;
    else if (what === "points") for (const cloud of this.clouds) cloud.object.visible = visible;
    else if (what === "truth") {
      this.trueMeshes.object.visible = visible;
      for (const truth of this.truths) truth.object.visible = visible && truth.known;
    }
    else this.scene.getObjectByName("axes")?.traverse((o) => { o.visible = visible; });
    this.drawSoon();
  }
  get touching(): number {
    return this.clouds[0]?.touching ?? 0;
  }
  // For a hand that is moved with them.
  leaveLeftButtonAndWheel(): void {
    this.controls.enableZoom = false;
    this.controls.touches.ONE = null;
    this.controls.mouseButtons = { LEFT: null, MIDDLE: THREE.MOUSE.PAN, RIGHT: THREE.MOUSE.ROTATE };
    // With shift the controls take moving for turning.
    this.canvas.addEventListener("pointerdown", (event) => {
      this.controls.mouseButtons.LEFT = event.shiftKey ? THREE.MOUSE.PAN : null;
    }, { capture: true });
  }
  zoom(wheel: number): void {
    const away = this.camera.position.clone().sub(this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(away, Math.exp(0.001 * wheel));
    this.controls.update();
  }
  // Of the picture, in the scene: to the right, up, and towards the camera.
  directions(): [THREE.Vector3, THREE.Vector3, THREE.Vector3] {
    const [x, y, z] = [0, 1, 2].map((k) => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, k));
    return [x, y, z];
  }
  // How long a pixel is at that place.
  mmPerPixel(place: THREE.Vector3): number {
    const distance = Math.max(this.camera.position.clone().sub(place).dot(this.directions()[2]), 1);
    return (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360)) / Math.max(this.canvas.clientHeight, 1);
  }
  dispose(): void {
    cancelAnimationFrame(this.drawing);
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss(); // a browser gives few contexts to a page
  }
  // Once before the next picture of the browser, however much has changed till then.
  private drawSoon(): void {
    if (this.drawing !== 0) return;
    this.drawing = requestAnimationFrame(() => {
      this.drawing = 0;
      this.draw();
    });
  }
  draw(): void {
    const place = new THREE.Vector3(); // a label at the right edge is to the left of its arrow
    for (const text of this.labels) text.center.x = place.setFromMatrixPosition(text.matrixWorld).project(this.camera).x > 0.6 ? 1.05 : -0.05;
    this.renderer.render(this.scene, this.camera);
    this.showBar();
  }

  // Returns the direction towards a camera beside and above what the sensor sees.
  private beside(forward: Vector): THREE.Vector3 {
    const f = new THREE.Vector3(...forward), up = new THREE.Vector3(0, 1, 0), side = f.clone().cross(up);
    if (side.length() < 0.2) side.set(1, 0, 0); // it looks down
    return side.normalize().addScaledVector(f.setY(0), -0.5).addScaledVector(up, 0.35);
  }
  private vector(name: string): THREE.Vector3 {
    const run = this.runs[0], v = run.vector(name, run.known(this.tick));
    return v.every(Number.isFinite) ? new THREE.Vector3(...v) : new THREE.Vector3();
  }
  private awayFromForce(): THREE.Vector3 {
    const sensor = this.runs[0].stored.sensor, normal = this.vector("normal").normalize();
    const force = this.vector(this.runs[0].forceName), along = force.length() > 1e-9 ? force.normalize() : normal;
    const preferred = sensor ? new THREE.Vector3(...sensor.forward).negate() : new THREE.Vector3(0.35, 0.3, 1).normalize();
    return acrossForce(along, normal, preferred);
  }
  // Returns the distance, mm, at which the camera sees proxy, hand, slave and force together, and the proxy is wide enough.
  private nearDistance(): number {
    const arrow = Math.min(this.mmPerN * this.vector(this.runs[0].forceName).length(), this.longestMm);
    const proxy = this.vector("proxy_position"), away = (name: string) => 1000 * this.vector(name).distanceTo(proxy);
    const hand = Math.max(away("hip_position"), this.slaves[0].object.visible ? away("slave_position") : 0);
    const least = this.runs[0].stored.tool ? 0 : 5 * this.proxyMm, { clientWidth: width, clientHeight: height } = this.canvas;
    const radius = 1.2 * (Math.max(hand, arrow, least) + this.proxyMm);
    const most = distanceOf((this.proxyMm * (height || 480)) / leastProxyPx, this.camera.fov, 1);
    return Math.min(distanceOf(radius / seen, this.camera.fov, width / height || 1.5), most);
  }
  // The motion of the proxy takes most of the action: from where all of it is seen, the proxy is small.
  private goesFar(): boolean {
    const way = new THREE.Box3(), run = this.runs[0], place = new THREE.Vector3();
    for (let tick = 0; tick < run.ticks; ++tick) {
      place.set(...run.vector("proxy_position", tick)).multiplyScalar(1000);
      if (Number.isFinite(place.length())) way.expandByPoint(place);
    }
    return way.getSize(place).length() > 0.6 * this.size;
  }
  private actionBox(): THREE.Box3 {
    const { low_m: low, high_m: high } = this.runs[0].stored, corner = (p: Vector) => new THREE.Vector3(...p).multiplyScalar(1000);
    return new THREE.Box3(corner(low), corner(high));
  }
  // From where a camera in that direction sees the whole action.
  private distance(away: THREE.Vector3): number {
    const right = this.camera.up.clone().cross(away).normalize(), up = away.clone().cross(right);
    const high = seen * Math.tan((this.camera.fov * Math.PI) / 360), wide = high * (this.canvas.clientWidth / this.canvas.clientHeight || 1.5);
    const { min, max } = this.actionBox();
    let far = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const c = new THREE.Vector3(corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y, corner & 4 ? max.z : min.z).sub(this.middle);
      far = Math.max(far, c.dot(away) + Math.max(Math.abs(c.dot(right)) / wide, Math.abs(c.dot(up)) / high));
    }
    return far;
  }
  private followProxy(tick: number): void {
    const run = this.runs[0], p = run.vector("proxy_position", run.known(tick));
    if (!p.every(Number.isFinite)) return;
    const now = new THREE.Vector3(1000 * p[0], 1000 * p[1], 1000 * p[2]), moved = now.clone().sub(this.followed);
    this.camera.position.add(moved);
    this.controls.target.add(moved);
    this.followed = now;
    this.controls.update();
  }
  private light(): void {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x777777, 2.2));
    const lamp = new THREE.DirectionalLight(0xffffff, 1.6);
    lamp.position.set(0.4, 1, 0.7);
    this.scene.add(lamp);
  }
  // Arrows of a round length along x, y and z, with their names.
  private axes(): THREE.Group {
    const axes = new THREE.Group(), length = round125(0.15 * this.size), origin = new THREE.Vector3();
    (["x", "y", "z"] as const).forEach((name, k) => {
      const along = new THREE.Vector3().setComponent(k, 1);
      const text = label(k === 0 ? `x, ${length} mm` : name);
      text.position.copy(along).multiplyScalar(1.2 * length);
      this.labels.push(text);
      axes.add(new THREE.ArrowHelper(along, origin, length, 0xbbbbbb, 0.1 * length, 0.06 * length), text);
    });
    axes.name = "axes";
    axes.position.copy(this.actionBox().min);
    return axes;
  }
  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    const changed = this.camera.aspect !== width / height;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (changed && this.across) this.setCamera("across");
    this.drawSoon();
  }
  // How long a millimetre is where the camera looks.
  private showBar(): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const mmPerPixel = (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360)) / Math.max(this.canvas.clientHeight, 1);
    const length = round125(120 * mmPerPixel);
    this.bar.style.width = `${length / mmPerPixel}px`;
    this.bar.textContent = `${length} mm`;
  }
}
