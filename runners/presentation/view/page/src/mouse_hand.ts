// The mouse as a hand: dragging moves it in the plane of the view, the wheel along the view, keys turn it.
import * as THREE from "three";
import type { HandPose } from "./connection";
import type { Vector } from "./data";
import type { SceneView } from "./scene";

const wheelMm = 2, turn = Math.PI / 60;
const turns: Record<string, [number, number, number]> = { // about axes of the camera: right, up, towards it
  w: [-1, 0, 0], s: [1, 0, 0], a: [0, -1, 0], d: [0, 1, 0], q: [0, 0, 1], e: [0, 0, -1],
};

export class MouseHand {
  isActive = true; // else the mouse moves nothing
  private readonly place: THREE.Vector3; // mm
  private readonly turned = new THREE.Quaternion();
  private buttons = 0;

  constructor(private readonly scene: SceneView, canvas: HTMLCanvasElement, start: Vector, orientation: number[],
    private readonly send: (pose: HandPose) => void) {
    this.place = new THREE.Vector3();
    this.start(start, orientation);
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
    window.addEventListener("blur", () => this.letGo());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      if (event.ctrlKey) this.scene.zoom(event.deltaY);
      else this.push(-Math.sign(event.deltaY) * wheelMm);
    }, { passive: false });
    document.addEventListener("keydown", (event) => this.key(event, true));
    document.addEventListener("keyup", (event) => this.key(event, false));
  }

  // The hand moves from here on.
  start(position: Vector, orientation: number[]): void {
    const [w, x, y, z] = orientation;
    this.place.set(...position).multiplyScalar(1000);
    if (orientation.every(Number.isFinite)) this.turned.set(x, y, z, w);
    this.buttons = 0;
  }
  private letGo(): void {
    if (this.buttons === 0) return;
    this.buttons = 0;
    this.tell();
  }
  private drag(right: number, down: number): void {
    const mm = this.scene.mmPerPixel(this.place), [x, y] = this.scene.directions();
    this.place.addScaledVector(x, right * mm).addScaledVector(y, -down * mm);
    this.tell();
  }
  // Away from the camera.
  private push(mm: number): void {
    this.place.addScaledVector(this.scene.directions()[2], -mm);
    this.tell();
  }
  private key(event: KeyboardEvent, down: boolean): void {
    if (event.key === "b" && !down) this.letGo(); // wherever the focus is now
    if (event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement) return;
    if (event.key === "b" && down && !event.repeat) {
      this.buttons = 1;
      this.tell();
    }
    if (event.key === "PageUp" || event.key === "PageDown") {
      event.preventDefault();
      if (down) this.push(event.key === "PageUp" ? wheelMm : -wheelMm);
    }
    const axis = turns[event.key];
    if (!axis || !down || event.ctrlKey || event.metaKey) return;
    const about = new THREE.Vector3();
    this.scene.directions().forEach((direction, k) => { about.addScaledVector(direction, axis[k]); });
    this.turned.premultiply(new THREE.Quaternion().setFromAxisAngle(about.normalize(), turn)).normalize();
    this.tell();
  }
  private tell(): void {
    if (!this.isActive) return;
    const { x, y, z } = this.place, q = this.turned;
    this.send({ position: [x / 1000, y / 1000, z / 1000], orientation: [q.w, q.x, q.y, q.z], buttons: this.buttons });
  }
}
