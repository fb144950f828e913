// Textures and own colours of objects: what the command wrote, decoded, and the materials that show them.
import * as THREE from "three";
import { readRuns, type Blobs, type Look, type Shown, type SurfaceMaterial } from "./data";

/** Own colours and texture of a shape. */
export interface ShapeLook {
  /** Red, green, blue of each vertex, or of each triangle. */
  vertexColours?: Uint8Array;
  faceColours?: Uint8Array;
  texture?: ShapeTexture;
}

export interface ShapeTexture {
  /** Vertices with texture coordinates: the vertex of each, and u and v, with v from the bottom of the image. */
  vertices: Uint32Array;
  places: Float32Array;
  /** For each corner of each triangle, its textured vertex. */
  corners: Uint32Array;
  materials: SurfaceMaterial[];
  /** Index in `materials` of each triangle; -1: none. */
  of: Int16Array;
  images: THREE.Texture[];
  /** Shows the images of full size instead of small ones. */
  refine?: () => Promise<void>;
}

const wraps = { repeat: THREE.RepeatWrapping, clamp: THREE.ClampToEdgeWrapping, mirror: THREE.MirroredRepeatWrapping };

/** Decodes an image; colours and opacity stay as they are in the file. */
function decodeImage(bytes: Uint8Array, type: string): Promise<ImageBitmap> {
  const options: ImageBitmapOptions = { premultiplyAlpha: "none", colorSpaceConversion: "none", imageOrientation: "none" };
  return createImageBitmap(new Blob([bytes as BlobPart], { type }), options);
}

/** A texture for each material, with its wrapping. */
function texturesOf(materials: SurfaceMaterial[], images: ImageBitmap[]): THREE.Texture[] {
  return materials.map((material) => {
    const texture = new THREE.Texture();
    if (material.image === undefined) return texture;
    texture.source = new THREE.TextureSource(images[material.image]);
    texture.flipY = false;
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.anisotropy = 8;
    [texture.wrapS, texture.wrapT] = (material.wrap ?? ["repeat", "repeat"]).map((one) => wraps[one]) as [THREE.Wrapping, THREE.Wrapping];
    if (material.nearest) texture.magFilter = THREE.NearestFilter;
    texture.needsUpdate = true;
    return texture;
  });
}

/** Replaces small images, which were shown first, by those of full size. Returns false if there is nothing to replace. */
export async function refine(look: ShapeLook | undefined): Promise<boolean> {
  const work = look?.texture?.refine;
  if (!work) return false;
  look.texture!.refine = undefined;
  await work();
  return true;
}

/** Index of the material of each triangle. */
function materialsOfTriangles(look: Look, triangles: number, blobs: Blobs): Int16Array {
  const of = new Int16Array(triangles).fill(-1);
  look.materials.forEach((material, i) => {
    if (material.faces === undefined) of.fill(i);
    else for (const face of readRuns(blobs.get(material.faces))) of[face] = i;
  });
  return of;
}

/** Starts to decode the images of a shape, while its geometry is decoded: small ones where there are. */
export function decodeImages(about: Shown, blobs: Blobs): Promise<ImageBitmap[]> {
  const images = (about.shape?.texture ?? about.texture)?.images ?? [];
  return Promise.all(images.map(({ preview, blob, type }) => decodeImage(blobs.get(preview?.blob ?? blob), preview?.type ?? type)));
}

const words = (bytes: Uint8Array) => new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.byteLength / 4);

/** The look of a shape. `packed`: textured vertices in its geometry, if they are there. */
export function lookOf(
  about: Shown,
  triangles: Uint32Array,
  vertices: number,
  blobs: Blobs,
  images: ImageBitmap[],
  packed?: Pick<ShapeTexture, "vertices" | "places" | "corners">,
): ShapeLook {
  const { colours, texture } = about.shape ?? about;
  const made: ShapeLook = {};
  if (colours?.vertices !== undefined) made.vertexColours = blobs.get(colours.vertices);
  if (colours?.faces !== undefined) made.faceColours = blobs.get(colours.faces);
  if (!texture) return made;
  let textured = packed;
  if (texture.vertices !== undefined && texture.places !== undefined && texture.corners !== undefined) {
    const places = blobs.get(texture.places);
    textured = {
      vertices: words(blobs.get(texture.vertices)),
      places: new Float32Array(places.buffer, places.byteOffset, places.byteLength / 4),
      corners: words(blobs.get(texture.corners)),
    };
  }
  // Materials of plain colours need no texture coordinates.
  textured ??= {
    vertices: Uint32Array.from({ length: vertices }, (_, i) => i),
    places: new Float32Array(2 * vertices),
    corners: triangles,
  };
  made.texture = {
    ...textured,
    materials: texture.materials,
    of: materialsOfTriangles(texture, triangles.length / 3, blobs),
    images: texturesOf(texture.materials, images),
  };
  const { materials, images: textures } = made.texture;
  if (texture.images.some((one) => one.preview))
    made.texture.refine = async () => {
      for (const [number, image] of texture.images.entries()) {
        if (!image.preview) continue;
        const source = new THREE.TextureSource(await decodeImage(blobs.get(image.blob), image.type));
        materials.forEach((material, i) => {
          if (material.image !== number) return;
          textures[i].dispose();
          textures[i].source = source;
          textures[i].needsUpdate = true;
        });
      }
    };
  return made;
}

/** Whether a material asks to be shown without light and shade. */
export const isUnlit = (look: ShapeLook | undefined) => look?.texture?.materials.some((one) => one.unlit) ?? false;

/** Variants of the surface's material, one per material of the texture. `vertexShader` and `fragmentShader` show a texture if TEXTURED is
 * defined, with an image if IMAGE is. */
export function texturedMaterials(texture: ShapeTexture, surface: THREE.RawShaderMaterial): THREE.RawShaderMaterial[] {
  return texture.materials.map((material, i) => {
    const hasImage = material.image !== undefined;
    return new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      side: THREE.DoubleSide,
      defines: hasImage ? { TEXTURED: 1, IMAGE: 1 } : { TEXTURED: 1 },
      uniforms: {
        ...surface.uniforms,
        image: { value: hasImage ? texture.images[i] : null },
        factor: { value: new THREE.Vector4(...material.colour) },
        cutoff: { value: material.cutoff ?? -1 },
      },
      vertexShader: surface.vertexShader,
      fragmentShader: surface.fragmentShader,
    });
  });
}

/** Number of every combination of region set, material and own colour of triangles: vertices are shared within a combination. */
export interface Kinds {
  of: Uint32Array;
  set: number[];
  material: number[];
  /** A triangle with this combination, whose own colour it has. */
  triangle: number[];
}

export function kindsOf(sets: Uint32Array, look: ShapeLook | undefined): Kinds {
  const of = new Uint32Array(sets.length);
  const made: Kinds = { of, set: [], material: [], triangle: [] };
  const numbers = new Map<number, number>();
  const materials = (look?.texture?.materials.length ?? 0) + 1;
  const colours = look?.faceColours;
  let last = -1;
  let number = 0;
  for (let t = 0; t < sets.length; ++t) {
    const material = look?.texture?.of[t] ?? -1;
    const colour = colours ? (colours[3 * t] << 16) | (colours[3 * t + 1] << 8) | colours[3 * t + 2] : 0;
    const key = (sets[t] * materials + material + 1) * 0x1000000 + colour;
    if (key !== last) {
      let kind = numbers.get(key);
      if (kind === undefined) {
        kind = made.set.push(sets[t]) - 1;
        made.material.push(material);
        made.triangle.push(t);
        numbers.set(key, kind);
      }
      last = key;
      number = kind;
    }
    of[t] = number;
  }
  return made;
}

/** Orders the corners by material, so that each material draws one range of them. */
export function rangesByMaterial(
  corners: Uint32Array,
  texture: ShapeTexture,
): { index: Uint32Array; ranges: { start: number; count: number; material: number }[] } {
  const count = texture.materials.length + 1;
  const { of } = texture;
  let isOne = of.length > 0;
  for (let t = 1; t < of.length && isOne; ++t) isOne = of[t] === of[0];
  if (isOne) return { index: corners, ranges: [{ start: 0, count: corners.length, material: of[0] + 1 }] };
  const begin = new Uint32Array(count + 1);
  for (let t = 0; t < of.length; ++t) begin[of[t] + 2] += 3;
  for (let i = 0; i < count; ++i) begin[i + 1] += begin[i];
  const index = new Uint32Array(corners.length);
  const next = begin.slice();
  for (let t = 0; t < of.length; ++t) {
    const at = next[of[t] + 1];
    index[at] = corners[3 * t];
    index[at + 1] = corners[3 * t + 1];
    index[at + 2] = corners[3 * t + 2];
    next[of[t] + 1] += 3;
  }
  const ranges = [];
  for (let i = 0; i < count; ++i)
    if (begin[i + 1] > begin[i]) ranges.push({ start: begin[i], count: begin[i + 1] - begin[i], material: i });
  return { index, ranges };
}
