/** One hand as objects of the 3D library, with their buffers on the graphics card. */

import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Mesh, Points, Quaternion, ShaderMaterial, Vector3 } from "three";
import { closestOnMesh } from "../../model/closest";
import { HAND_COLORS } from "../../model/joints";
import { boxOf, edgesOf, normalsOf, spacingOf, type HandGeometry, type Surface } from "./geometry";
import { createMaterial, type Uniforms } from "./shading";

const SCAN_COLOR = "#cfc8bf";
/** Lines between scan and mesh: so many that one still sees through them. */
const LINES = 1500;

export interface Staged {
  readonly root: Group;
  readonly scan: Points | Mesh;
  readonly mesh: Mesh | null;
  readonly wireframe: LineSegments | null;
  /** Made when they are first asked for; null without a mesh. */
  lines: () => LineSegments | null;
  hasLines: () => boolean;
  /** Of what is shown, m. */
  readonly radius: number;
  readonly geometry: HandGeometry;
  /** Whether there is a mesh to be seen now. */
  hasMesh: () => boolean;
  /** 1 for points of the scan to be shown as taken away. */
  take: (taken: Uint8Array) => void;
  /** Put the mesh's vertices elsewhere; what is in the middle stays. */
  move: (positions: Float32Array) => void;
  /** Another frame in the place of this one; the eye stays. The mesh has the same triangles, or there is none. */
  renew: (scan: Surface, mesh: Surface | null) => void;
  release: () => void;
}

function bufferOf({ positions, normals, colors, index, errorMm, taken }: Surface): BufferGeometry {
  const count = positions.length / 3;
  const made = new BufferGeometry();
  const toEye = normals ?? (index ? normalsOf(positions, index) : null);
  made.setAttribute("position", new BufferAttribute(positions, 3));
  made.setAttribute("normal", new BufferAttribute(toEye ?? new Int8Array(3 * count), 3, toEye instanceof Int8Array));
  made.setAttribute("tint", new BufferAttribute(colors ?? new Uint8Array(3 * count), 3, true));
  made.setAttribute("errorMm", new BufferAttribute(errorMm ?? new Float32Array(count).fill(-1), 1));
  made.setAttribute("taken", new BufferAttribute(taken?.slice() ?? new Uint8Array(count), 1));
  if (index) made.setIndex(new BufferAttribute(index, 1));
  return made;
}

/** Other values for an attribute; its buffer is kept where they fit in. */
function refill(buffer: BufferGeometry, name: string, values: Float32Array | Int8Array | Uint8Array, size: number): void {
  const held = buffer.getAttribute(name) as BufferAttribute;
  if (held.array.constructor !== values.constructor || held.array.length < values.length) {
    buffer.setAttribute(name, new BufferAttribute(values, size, held.normalized));
    return;
  }
  held.array.set(values);
  held.needsUpdate = true;
}

function renewBuffer(buffer: BufferGeometry, { positions, normals, colors, errorMm }: Surface): void {
  const count = positions.length / 3;
  refill(buffer, "position", positions, 3);
  refill(buffer, "normal", normals ?? new Int8Array(3 * count), 3);
  refill(buffer, "tint", colors ?? new Uint8Array(3 * count), 3);
  refill(buffer, "errorMm", errorMm ?? new Float32Array(count).fill(-1), 1);
  if (!buffer.index) buffer.setDrawRange(0, count);
}

function wiresOf({ positions, index }: Surface): LineSegments | null {
  if (!index) return null;
  const made = new BufferGeometry();
  made.setAttribute("position", new BufferAttribute(positions, 3));
  made.setIndex(new BufferAttribute(edgesOf(index), 1));
  return new LineSegments(made, new LineBasicMaterial({ color: 0x14171b, transparent: true, opacity: 0.7 }));
}

/** From points of the scan to the mesh, spread evenly over the scan. */
function linesOf({ positions: points }: Surface, { positions, index }: Surface): LineSegments | null {
  if (!index) return null;
  const count = points.length / 3;
  const step = Math.max(1, Math.floor(count / LINES));
  const starts = Float32Array.from({ length: 3 * Math.ceil(count / step) }, (_, at) => points[3 * step * Math.floor(at / 3) + (at % 3)] as number);
  const ends = closestOnMesh(starts, positions, index);
  const both = new Float32Array(2 * starts.length);
  for (let line = 0; 3 * line < starts.length; line += 1) {
    both.set(starts.subarray(3 * line, 3 * line + 3), 6 * line);
    both.set(ends.subarray(3 * line, 3 * line + 3), 6 * line + 3);
  }
  const made = new BufferGeometry();
  made.setAttribute("position", new BufferAttribute(both, 3));
  return new LineSegments(made, new LineBasicMaterial({ color: 0xc77dff }));
}

export function stageHand(geometry: HandGeometry, uniforms: Uniforms): Staged {
  const { scan: scanned, mesh: fitted, side, upright } = geometry;
  const scanMaterial = createMaterial(uniforms, { plain: SCAN_COLOR, isPoint: !scanned.index, hasTint: scanned.colors !== null, radius: geometry.spacing ?? spacingOf(scanned.positions) });
  const scanBuffer = bufferOf(scanned);
  const scan = scanned.index ? new Mesh(scanBuffer, scanMaterial) : new Points(scanBuffer, scanMaterial);
  const mesh = fitted && new Mesh(bufferOf(fitted), createMaterial(uniforms, { plain: HAND_COLORS[side ?? "right"], isPoint: false, hasTint: fitted.colors !== null, radius: 0 }));
  const wireframe = fitted && wiresOf(fitted);
  const parts: (Points | Mesh | LineSegments)[] = [scan, mesh, wireframe].flatMap((part) => part ?? []);
  let lines: LineSegments | null = null;
  let isMeshThere = mesh !== null;

  // With a mesh the hand is in the middle, not the hand with its forearm and whatever it holds.
  const box = geometry.box ?? boxOf(fitted?.positions ?? scanned.positions);
  const root = new Group();
  const inner = new Group();
  inner.position.copy(new Vector3(...box.centre).negate());
  root.quaternion.copy(new Quaternion(...upright));
  root.add(inner);
  const add = (part: Points | Mesh | LineSegments): void => {
    part.frustumCulled = false;
    inner.add(part);
  };
  parts.forEach(add);
  root.updateMatrixWorld(true);
  return {
    root,
    scan,
    mesh,
    wireframe,
    hasMesh: () => isMeshThere,
    lines() {
      if (lines || !fitted) return lines;
      lines = linesOf(scanned, fitted);
      if (lines) {
        parts.push(lines);
        add(lines);
      }
      return lines;
    },
    hasLines: () => lines !== null,
    radius: box.radius,
    geometry,
    take(taken) {
      const attribute = scanBuffer.getAttribute("taken") as BufferAttribute;
      attribute.set(taken);
      attribute.needsUpdate = true;
    },
    move(positions) {
      if (!mesh || !fitted?.index) return;
      const normals = normalsOf(positions, fitted.index);
      for (const part of [mesh, wireframe]) {
        for (const [name, values] of [["position", positions], ["normal", normals]] as const) {
          const attribute = part?.geometry.getAttribute(name) as BufferAttribute | undefined;
          attribute?.copyArray(values);
          if (attribute) attribute.needsUpdate = true;
        }
      }
    },
    renew(nextScan, nextMesh) {
      renewBuffer(scanBuffer, nextScan);
      isMeshThere = mesh !== null && nextMesh !== null;
      if (!mesh || !nextMesh) return;
      renewBuffer(mesh.geometry, nextMesh);
      if (wireframe) refill(wireframe.geometry, "position", nextMesh.positions, 3);
    },
    release() {
      for (const part of parts) {
        part.geometry.dispose();
        (part.material as ShaderMaterial | LineBasicMaterial).dispose();
      }
    },
  };
}
