// Computes the positions of a world's points on the screen, independently of the page's camera. The tests compare the
// pictures of the page with these positions.

import type { Page } from "puppeteer-core";
import { PerspectiveCamera, Vector3 } from "three";
import type { Vec3 } from "../src/protocol";

export interface Spot {
  x: number;
  y: number;
}

interface Rectangle extends Spot {
  width: number;
  height: number;
}

export type Projection = (at: Vec3) => Spot;

async function canvasOf(page: Page): Promise<Rectangle> {
  const box = await (await page.$("#canvas"))?.boundingBox();
  if (!box) throw new Error("the canvas has no size");
  return box;
}

/** The fraction of the canvas that fitted bounds cover. */
const FILL = 0.9;

/**
 * Returns the projection of a 2D world with fitted bounds: they cover the fraction `FILL` of the height or the width.
 */
export async function projection2(page: Page, [low, high]: [Vec3, Vec3]): Promise<Projection> {
  const { x, y, width, height } = await canvasOf(page);
  const scale = FILL * Math.min(width / (high[0] - low[0]), height / (high[1] - low[1]));
  const [cx, cy] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  return (at) => ({ x: x + width / 2 + (at[0] - cx) * scale, y: y + height / 2 - (at[1] - cy) * scale });
}

/** Returns the corners of a box. */
export function corners([low, high]: [Vec3, Vec3]): Vec3[] {
  return [0, 1, 2, 3, 4, 5, 6, 7].map(
    (bits) => [0, 1, 2].map((axis) => ((bits >> axis) & 1 ? high : low)[axis]!) as Vec3,
  );
}

/**
 * Returns the projection of a 3D world with y up. Its bounds are in the middle of a field of view of 38 degrees, and
 * cover the fraction `FILL` of the height or the width. The page computes the distance of the camera in closed form.
 * Here an iteration centres the bounds, then moves the camera nearer or farther.
 */
export async function projection3(page: Page, bounds: [Vec3, Vec3]): Promise<Projection> {
  const { x, y, width, height } = await canvasOf(page);
  const camera = new PerspectiveCamera(38, width / height, 0.01, 1000);
  const points = corners(bounds).map((corner) => new Vector3(...corner));
  const back = new Vector3(0.55, 0, 1).normalize().setY(0.42).normalize();
  const right = new Vector3(0, 1, 0).cross(back).normalize();
  const up = new Vector3().crossVectors(back, right);
  const target = points[0]!.clone().add(points[7]!).divideScalar(2);
  let distance = 10 * points[0]!.distanceTo(points[7]!);
  for (let trial = 0; trial < 200; trial += 1) {
    camera.position.copy(target).addScaledVector(back, distance);
    camera.lookAt(target);
    camera.updateMatrixWorld();
    const devices = points.map((point) => point.clone().project(camera));
    const ends = (axis: "x" | "y"): [number, number] => {
      const parts = devices.map((device) => device[axis]);
      return [Math.min(...parts), Math.max(...parts)];
    };
    const [[left, rightmost], [bottom, top]] = [ends("x"), ends("y")];
    const half = distance * Math.tan((19 * Math.PI) / 180);
    target.addScaledVector(right, ((left + rightmost) / 2) * half * camera.aspect);
    target.addScaledVector(up, ((bottom + top) / 2) * half);
    distance *= Math.max((rightmost - left) / 2, (top - bottom) / 2) / FILL;
  }
  return (at) => {
    const device = new Vector3(...at).project(camera);
    return { x: x + ((device.x + 1) / 2) * width, y: y + ((1 - device.y) / 2) * height };
  };
}

/**
 * The box around the pixels of the canvas whose colours a test accepts, in CSS pixels, and the number of these pixels.
 */
export interface Silhouette {
  low: Spot;
  high: Spot;
  pixels: number;
}

/** Takes a screenshot and computes the silhouette in the page, which can decode the screenshot. */
export async function silhouette(page: Page, kind: "blue" | "solid"): Promise<Silhouette> {
  const { x, y, width, height } = await canvasOf(page);
  await page.addStyleTag({ content: "#hint, #labels { display: none }" });
  const picture = await page.screenshot({ clip: { x, y, width, height }, encoding: "base64" });
  const found = await page.evaluate(readPicture, picture, kind);
  const shift = (spot: Spot): Spot => ({ x: spot.x + x, y: spot.y + y });
  return { low: shift(found.low), high: shift(found.high), pixels: found.pixels };
}

/**
 * Runs in the page. In blue pixels the blue channel clearly exceeds red and green; solid pixels are darker than the
 * background.
 */
async function readPicture(picture: string, kind: "blue" | "solid"): Promise<Silhouette> {
  const image = new Image();
  image.src = `data:image/png;base64,${picture}`;
  await image.decode();
  const canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext("2d")!;
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  const result = { low: { x: Infinity, y: Infinity }, high: { x: -Infinity, y: -Infinity }, pixels: 0 };
  for (let index = 0; index < data.length; index += 4) {
    const [red, green, blue] = [data[index]!, data[index + 1]!, data[index + 2]!];
    const accepted = kind === "blue" ? blue > red + 50 && blue > green + 20 : red + green + blue < 560;
    if (!accepted) continue;
    const [x, y] = [(index / 4) % image.width, Math.floor(index / 4 / image.width)];
    result.low = { x: Math.min(result.low.x, x), y: Math.min(result.low.y, y) };
    result.high = { x: Math.max(result.high.x, x + 1), y: Math.max(result.high.y, y + 1) };
    result.pixels += 1;
  }
  return result;
}
