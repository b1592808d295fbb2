// Chooses the direction from which a camera sees a contact best.
import * as THREE from "three";

const heights = [15, 25, 40]; // degrees above the horizon
const turns = 36;

// Returns a direction across the force, with y upwards in the picture, in front of the surface, and otherwise as near as
// possible to `preferred`.
// Unit vectors towards the camera; along: the direction of the force; front: the surface's normal. Either may be 0.
export function acrossForce(along: THREE.Vector3, front: THREE.Vector3, preferred: THREE.Vector3): THREE.Vector3 {
  let best = preferred.clone(), most = Number.NEGATIVE_INFINITY;
  for (const height of heights)
    for (let turn = 0; turn < turns; ++turn) {
      const azimuth = (2 * Math.PI * turn) / turns, up = THREE.MathUtils.degToRad(height);
      const away = new THREE.Vector3(Math.cos(up) * Math.sin(azimuth), Math.sin(up), Math.cos(up) * Math.cos(azimuth));
      const value = 2 * (1 - away.dot(along) ** 2) + 0.5 * away.dot(preferred) + Math.min(away.dot(front), 0);
      if (value > most) [most, best] = [value, away];
    }
  return best;
}

// Returns the distance at which a ball of this radius fills the picture. fov: degrees, of the picture's height.
export function distanceOf(radius: number, fov: number, aspect: number): number {
  return radius / (Math.tan(THREE.MathUtils.degToRad(fov / 2)) * Math.min(aspect, 1));
}
