// The mouse as a hand: dragging moves it in the plane of the view, the wheel along the view. Keys move and turn it, too.
import * as THREE from "three";
import type { HandPose } from "./connection";
import type { Vector } from "./data";
import type { SceneView } from "./scene";

// How far a key or a notch of the wheel moves and turns the hand.
const steps = { usual: { mm: 2, degrees: 3 }, fine: { mm: 0.2, degrees: 0.3 }, coarse: { mm: 10, degrees: 15 } } as const;
type Step = keyof typeof steps;

// Axes of rotation and directions of motion in the frame of the camera: right, up, towards the camera.
const turns: Record<string, [number, number, number]> = {
  w: [-1, 0, 0], s: [1, 0, 0], a: [0, -1, 0], d: [0, 1, 0], q: [0, 0, 1], e: [0, 0, -1],
};
const moves: Record<string, [number, number, number]> = {
  ArrowRight: [1, 0, 0], ArrowLeft: [-1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0], PageUp: [0, 0, -1], PageDown: [0, 0, 1],
};

function stepOf(event: KeyboardEvent | WheelEvent): Step {
  return event.shiftKey ? "fine" : event.altKey ? "coarse" : "usual";
}

export class MouseHand {
  private active = false;
  private step: Step = "usual";
  private readonly place: THREE.Vector3; // mm
  private readonly turned = new THREE.Quaternion();
  private buttons = 0;

  constructor(private readonly scene: SceneView, canvas: HTMLCanvasElement, private readonly send: (pose: HandPose) => void) {
    this.place = new THREE.Vector3();
    let before: PointerEvent | null = null;
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || event.shiftKey || !event.isPrimary) return;
      canvas.setPointerCapture(event.pointerId);
      before = event;
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons !== 1 || event.shiftKey || !event.isPrimary || !before) return;
      this.drag(event.clientX - before.clientX, event.clientY - before.clientY);
      before = event;
    });
    canvas.addEventListener("pointerup", () => { before = null; });
    window.addEventListener("blur", () => {
      this.step = "usual";
      this.letGo();
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      if (event.ctrlKey) this.scene.zoom(event.deltaY);
      else this.move([0, 0, Math.sign(event.deltaY || event.deltaX)], stepOf(event)); // with shift, browsers swap deltaX and deltaY
    }, { passive: false });
    document.addEventListener("keydown", (event) => this.key(event, true));
    document.addEventListener("keyup", (event) => this.key(event, false));
  }

  // True while the mouse and the keys move the hand. Motion that the user cannot see is not counted, but the release of a
  // button is.
  set isActive(active: boolean) {
    const begins = active && !this.active;
    this.active = active;
    if (begins) this.tell();
  }
  get isActive(): boolean {
    return this.active;
  }
  // Returns the size of the present step, and the keys for other steps.
  get stepText(): string {
    const text = (step: Step) => `${steps[step].mm} mm, ${steps[step].degrees}°`;
    return this.step === "usual" ? `Step: ${text("usual")} (Shift: ${text("fine")}; Alt: ${text("coarse")})` : `${this.step === "fine" ? "Fine" : "Coarse"} step: ${text(this.step)}`;
  }
  // The hand moves from here on. The run is told, because it counts all later motion from here.
  start(position: Vector, orientation: number[]): void {
    const [w, x, y, z] = orientation;
    this.place.set(...position).multiplyScalar(1000);
    if (orientation.every(Number.isFinite)) this.turned.set(x, y, z, w);
    this.buttons = 0;
    this.tell();
  }
  private letGo(): void {
    if (this.buttons === 0) return;
    this.buttons = 0;
    this.tell();
  }
  private drag(right: number, down: number): void {
    if (!this.active) return;
    const mm = this.scene.mmPerPixel(this.place), [x, y] = this.scene.directions();
    this.place.addScaledVector(x, right * mm).addScaledVector(y, -down * mm);
    this.tell();
  }
  private move(way: [number, number, number], step: Step): void {
    if (!this.active) return;
    this.scene.directions().forEach((direction, k) => { this.place.addScaledVector(direction, steps[step].mm * way[k]); });
    this.tell();
  }
  private turn(axis: [number, number, number], step: Step): void {
    if (!this.active) return;
    const about = new THREE.Vector3(), angle = (steps[step].degrees * Math.PI) / 180;
    this.scene.directions().forEach((direction, k) => { about.addScaledVector(direction, axis[k]); });
    this.turned.premultiply(new THREE.Quaternion().setFromAxisAngle(about.normalize(), angle)).normalize();
    this.tell();
  }
  private key(event: KeyboardEvent, down: boolean): void {
    this.step = stepOf(event);
    if (event.key === "b" && !down) this.letGo(); // wherever the focus is now
    if (event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement || document.querySelector("dialog[open]")) return;
    if (event.key === "b" && down && !event.repeat && this.active) {
      this.buttons = 1;
      this.tell();
    }
    const way = moves[event.key], axis = turns[event.key.toLowerCase()];
    if ((!way && !axis) || !down || event.ctrlKey || event.metaKey) return;
    event.preventDefault(); // Alt and an arrow would leave the page
    if (way) this.move(way, this.step);
    else this.turn(axis, this.step);
  }
  private tell(): void {
    if (!this.active) return;
    const { x, y, z } = this.place, q = this.turned;
    this.send({ position: [x / 1000, y / 1000, z / 1000], orientation: [q.w, q.x, q.y, q.z], buttons: this.buttons });
  }
}
