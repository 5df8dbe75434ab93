// The canvas that three.js draws on, when something changed and not before.
//
// The world is left-handed, three.js is not: everything in `world` is in the scene's own coordinates, and the group
// mirrors z once. Point clouds come mirrored and go into `mirrored`.
import * as THREE from "three";
import { axesOf, distanceOf, type Pose } from "../pose";
import { type Box, centreOf, diagonalOf, lengthOf, minus } from "../vec";

/// What of the view a part has to know to keep its size on the screen.
export interface Look {
  pose: Pose;
  width: number; // CSS pixels
  height: number;
  /// Of one pixel at a distance from the eye, in the scene's units.
  pixelAt(distance: number): number;
}

/// The next frame; another shall follow while something is on its way.
export interface Next {
  look: Look;
  box: Box; // around all that must not be cut off
  again: boolean;
}

export class Stage {
  readonly world = new THREE.Group();
  readonly mirrored = new THREE.Group();
  private readonly scene = new THREE.Scene();
  private readonly renderer: THREE.WebGLRenderer;
  private readonly perspective = new THREE.PerspectiveCamera();
  private readonly orthographic = new THREE.OrthographicCamera();
  private readonly headlight = new THREE.DirectionalLight(0xffffff, 2.2);
  private width = 0;
  private height = 0;
  private frame = 0;
  private last = 0;

  /// `step` is told the milliseconds since the last frame and prepares the next.
  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly step: (milliseconds: number) => Next,
  ) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.world.scale.z = -1;
    this.scene.add(this.world, this.mirrored, new THREE.HemisphereLight(0xffffff, 0x2a2f38, 0.9));
    this.scene.add(this.headlight); // aims at the origin: only its direction counts
  }

  setBackground(color: readonly [number, number, number]): void {
    this.scene.background = new THREE.Color().setRGB(...color);
    this.invalidate();
  }

  resize(width: number, height: number): void {
    [this.width, this.height] = [width, height];
    this.renderer.setSize(width, height, false);
    this.invalidate();
  }

  invalidate(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame((now) => this.tick(now));
  }

  lookOf(pose: Pose): Look {
    const pixels = (2 * Math.tan((pose.angleDeg * Math.PI) / 360)) / Math.max(this.height, 1);
    const pixelAt = (distance: number) => pixels * (pose.orthographic ? distanceOf(pose) : distance);
    return { pose, width: this.width, height: this.height, pixelAt };
  }

  /// The picture as it is now; it has to be taken in the same task.
  async png(): Promise<Blob> {
    this.draw(0);
    return new Promise((resolve, reject) => {
      this.canvas.toBlob((blob) =>
        blob ? resolve(blob) : reject(new Error("The browser could not make a PNG")),
      );
    });
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    for (const part of [...this.world.children, ...this.mirrored.children]) discard(part);
    this.renderer.dispose();
    this.renderer.forceContextLoss(); // browsers keep only a few
  }

  private tick(now: number): void {
    this.frame = 0;
    const pause = this.last === 0 ? 0 : now - this.last;
    const again = this.width > 0 && this.height > 0 && this.draw(Math.min(pause, 50));
    this.last = again ? now : 0;
    if (again) this.invalidate();
  }

  private draw(milliseconds: number): boolean {
    const { look, box, again } = this.step(milliseconds);
    this.renderer.render(this.scene, this.aim(look.pose, box));
    return again;
  }

  private aim(pose: Pose, box: Box): THREE.Camera {
    const distance = distanceOf(pose);
    const reach = lengthOf(minus(centreOf(box), pose.eye)) + 4 * diagonalOf(box);
    const tangent = Math.tan((pose.angleDeg * Math.PI) / 360);
    const aspect = this.width / this.height;
    const camera = pose.orthographic ? this.orthographic : this.perspective;
    if (camera instanceof THREE.PerspectiveCamera) {
      camera.fov = pose.angleDeg;
      camera.aspect = aspect;
      camera.near = Math.min(distance, reach) * 2e-3;
    } else {
      camera.top = tangent * distance;
      camera.right = camera.top * aspect;
      [camera.bottom, camera.left] = [-camera.top, -camera.right];
      camera.near = -reach;
    }
    camera.far = reach;
    const { up } = axesOf(pose);
    camera.up.set(up[0], up[1], -up[2]);
    camera.position.set(pose.eye[0], pose.eye[1], -pose.eye[2]);
    camera.lookAt(pose.target[0], pose.target[1], -pose.target[2]);
    camera.updateProjectionMatrix();
    // From the upper left behind the viewer, so that shapes are seen.
    this.headlight.position.set(-0.5, 0.7, 1).applyQuaternion(camera.quaternion);
    return camera;
  }
}

/// Takes a part out and frees what it holds on the GPU.
export function discard(part: THREE.Object3D): void {
  part.removeFromParent();
  part.traverse((object) => {
    const { geometry, material } = object as Partial<THREE.Mesh>;
    geometry?.dispose();
    for (const one of [material ?? []].flat()) {
      (one as THREE.SpriteMaterial).map?.dispose();
      one.dispose();
    }
    if (object instanceof THREE.InstancedMesh) object.dispose();
  });
}
