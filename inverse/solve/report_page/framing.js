"use strict";
// Where to look from: position and target, metres, and the vertical field of view, degrees.

const kOverviewField = 36;

// From the side that the scene's first camera stands on, a little above. aspect: width / height.
function fromOutside(box, cameras, aspect) {
  const center = box.getCenter(new THREE.Vector3()), side = new THREE.Vector3();
  if (cameras.length > 0) side.fromArray(cameras[0].position).sub(center).setY(0);
  if (!(side.length() > 0)) side.set(0.45, 0, 1);
  side.normalize().setY(0.5).normalize();
  const position = center.clone().addScaledVector(side, distanceToFit(box, center, side, aspect));
  return {position, target: center, field: kOverviewField};
}

// From the center, along `side`, at which all corners of the box are seen.
function distanceToFit(box, center, side, aspect) {
  const vertical = Math.tan((kOverviewField * Math.PI) / 360), horizontal = vertical * aspect;
  const camera = new THREE.PerspectiveCamera();
  camera.position.copy(side);
  camera.lookAt(0, 0, 0);
  const cameraFromWorld = camera.quaternion.clone().conjugate();
  const {min, max} = box, distances = [];
  for (let corner = 0; corner < 8; ++corner) {
    const at = new THREE.Vector3(corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y, corner & 4 ? max.z : min.z);
    at.sub(center).applyQuaternion(cameraFromWorld);
    distances.push(at.z + Math.max(Math.abs(at.x) / horizontal, Math.abs(at.y) / vertical));
  }
  return 1.03 * Math.max(...distances);
}

// The target is as far away as the middle of the box.
function throughCamera({position: [x, y, z], backward, vertical_fov}, box) {
  const position = new THREE.Vector3(x, y, z), back = new THREE.Vector3(...backward).normalize();
  const middle = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3()).length();
  const ahead = Math.max(0.1 * size, back.dot(position.clone().sub(middle)));
  return {position, target: position.clone().addScaledVector(back, -ahead), field: (vertical_fov * 180) / Math.PI};
}
