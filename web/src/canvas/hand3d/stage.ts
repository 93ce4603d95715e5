/** The 3D view of one hand: draws when something has changed, holds the next hands ready on the graphics card. */

import { Matrix4, PerspectiveCamera, Scene, Vector3, WebGLRenderer, WebGLRenderTarget } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { SCAN_ERROR_FULL_MM } from "../../model/errorColor";
import type { Projection } from "../../model/crop";
import type { HandGeometry } from "./geometry";
import { FIRST_LOOK, type Look, type ViewSide } from "./look";
import { createUniforms } from "./shading";
import { stageHand, type Staged } from "./staged";

/** Without a graphics card smooth edges take twice the time. */
function isDrawnInSoftware(): boolean {
  const probe = document.createElement("canvas").getContext("webgl2");
  const named = probe?.getExtension("WEBGL_debug_renderer_info");
  const name = probe && named ? String(probe.getParameter(named.UNMASKED_RENDERER_WEBGL)) : "";
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

const FIELD_DEG = 28;
const SECONDS_A_TURN = 8;

export interface Stage {
  /** Get a hand ready: its buffers are on the card when this returns. */
  prepare: (geometry: HandGeometry) => Staged;
  /** Draw this hand from now on; null draws nothing. Returns when it is drawn. */
  show: (hand: Staged | null) => void;
  /** Draw what is shown after it was renewed. */
  refresh: () => void;
  setLook: (look: Look) => void;
  lookFrom: (side: ViewSide) => void;
  /** Degrees to the right and up. */
  orbit: (right: number, up: number) => void;
  zoom: (factor: number) => void;
  /** The whole hand, from the palm's side. */
  reset: () => void;
  setGestures: (areOn: boolean) => void;
  /** Scan frame to clip space as things are on the screen now. */
  projection: () => Projection;
  draw: () => void;
  resize: (width: number, height: number) => void;
  stop: () => void;
}

export function createStage(canvas: HTMLCanvasElement, onDrawn: () => void): Stage {
  const renderer = new WebGLRenderer({ canvas, antialias: !isDrawnInSoftware(), alpha: true, powerPreference: "high-performance" });
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
  const scene = new Scene();
  const camera = new PerspectiveCamera(FIELD_DEG, 1, 0.01, 100);
  const uniforms = createUniforms(SCAN_ERROR_FULL_MM);
  const controls = new OrbitControls(camera, canvas);
  controls.enableDamping = false;
  const anteroom = new WebGLRenderTarget(1, 1);
  let shown: Staged | null = null;
  /** Of the last one shown, m. */
  let radius: number | null = null;
  let look = FIRST_LOOK;
  let frame = 0;
  let turnedAt = 0;

  const fitDistance = (radius: number): number => {
    const half = (FIELD_DEG * Math.PI) / 360;
    const narrow = Math.atan(Math.tan(half) * Math.min(1, camera.aspect));
    return (0.92 * radius) / Math.sin(narrow);
  };

  function place(direction: Vector3): void {
    const distance = fitDistance(radius ?? 0.12);
    controls.target.set(0, 0, 0);
    camera.up.set(0, 1, 0);
    camera.position.copy(direction.normalize().multiplyScalar(distance));
    controls.minDistance = distance * 0.1;
    controls.maxDistance = distance * 4;
    controls.update();
    later();
  }

  function applyLook(hand: Staged): void {
    const hasMesh = hand.hasMesh();
    hand.scan.visible = look.layers !== "mesh" || !hasMesh;
    if (hand.mesh) hand.mesh.visible = hasMesh && look.layers !== "scan";
    if (hand.wireframe) hand.wireframe.visible = hasMesh && look.hasWireframe && look.layers !== "scan";
    if (look.hasCorrespondences || hand.hasLines()) {
      const lines = hand.lines();
      if (lines) lines.visible = look.hasCorrespondences;
    }
  }

  function draw(): void {
    cancelAnimationFrame(frame);
    frame = 0;
    uniforms.grow.value = shown?.mesh?.visible ? 0.55 : 1.3;
    uniforms.hasErrors.value = look.hasErrors && shown?.hasMesh() ? 1 : 0;
    renderer.render(scene, camera);
    onDrawn();
  }

  function later(): void {
    if (frame === 0) frame = requestAnimationFrame(draw);
  }

  function turn(time: number): void {
    if (!look.isTurning) return;
    const seconds = Math.min(0.1, (time - turnedAt) / 1000);
    turnedAt = time;
    camera.position.applyAxisAngle(new Vector3(0, 1, 0), (2 * Math.PI * seconds) / SECONDS_A_TURN);
    controls.update();
    draw();
    requestAnimationFrame(turn);
  }

  controls.addEventListener("change", later);
  place(new Vector3(0, 0, 1));

  return {
    prepare(geometry) {
      const hand = stageHand(geometry, uniforms);
      // Drawing it once into a single pixel brings its buffers and programs to the card.
      const waiting = new Scene();
      waiting.add(hand.root);
      renderer.setRenderTarget(anteroom);
      renderer.render(waiting, camera);
      renderer.setRenderTarget(null);
      waiting.remove(hand.root);
      return hand;
    },
    show(hand) {
      if (shown) scene.remove(shown.root);
      shown = hand;
      if (hand) {
        applyLook(hand);
        scene.add(hand.root);
        // The eye stays where it is, nearer or farther by as much as the hand is smaller or larger.
        const grows = radius === null ? null : hand.radius / radius;
        radius = hand.radius;
        if (grows === null) place(new Vector3(0, 0, 1));
        else {
          camera.position.multiplyScalar(grows);
          controls.target.multiplyScalar(grows);
          controls.minDistance *= grows;
          controls.maxDistance *= grows;
        }
        controls.update();
      }
      draw();
    },
    refresh() {
      if (shown) applyLook(shown);
      draw();
    },
    setLook(next) {
      const starts = next.isTurning && !look.isTurning;
      look = next;
      if (shown) applyLook(shown);
      if (starts) {
        turnedAt = performance.now();
        requestAnimationFrame(turn);
      }
      later();
    },
    lookFrom(side) {
      const thumb = shown?.geometry.side === "left" ? -1 : 1;
      const directions: Record<ViewSide, Vector3> = {
        palm: new Vector3(0, 0, 1),
        back: new Vector3(0, 0, -1),
        thumb: new Vector3(thumb, 0, 0),
        little: new Vector3(-thumb, 0, 0),
      };
      place(directions[side]);
    },
    orbit(right, up) {
      const away = camera.position.clone().sub(controls.target);
      away.applyAxisAngle(new Vector3(0, 1, 0), (right * Math.PI) / 180);
      const aside = new Vector3(0, 1, 0).cross(away).normalize();
      const tilted = away.clone().applyAxisAngle(aside, (-up * Math.PI) / 180);
      const lean = tilted.angleTo(new Vector3(0, 1, 0));
      camera.position.copy(controls.target).add(lean > 0.05 && lean < Math.PI - 0.05 ? tilted : away);
      controls.update();
      later();
    },
    zoom(factor) {
      const away = camera.position.clone().sub(controls.target);
      away.setLength(Math.min(controls.maxDistance, Math.max(controls.minDistance, away.length() / factor)));
      camera.position.copy(controls.target).add(away);
      controls.update();
      later();
    },
    reset: () => place(new Vector3(0, 0, 1)),
    setGestures(areOn) {
      controls.enabled = areOn;
    },
    projection() {
      camera.updateMatrixWorld();
      const matrix = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
      if (shown) {
        shown.root.updateMatrixWorld(true);
        matrix.multiply(shown.scan.matrixWorld);
      }
      return matrix.transpose().elements;
    },
    draw,
    resize(width, height) {
      renderer.setSize(width, height, false);
      const old = fitDistance(1);
      camera.aspect = width / Math.max(1, height);
      camera.updateProjectionMatrix();
      uniforms.pixelsPerMetre.value = (height * renderer.getPixelRatio()) / (2 * Math.tan((FIELD_DEG * Math.PI) / 360));
      camera.position.multiplyScalar(fitDistance(1) / old);
      controls.update();
      draw();
    },
    stop() {
      look = FIRST_LOOK;
      cancelAnimationFrame(frame);
      controls.dispose();
      anteroom.dispose();
      renderer.dispose();
    },
  };
}
