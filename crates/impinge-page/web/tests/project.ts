// Where points of a world are on the screen, computed here by itself, so that the page's own camera is tested against it.

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

/** Of a world in 2D whose bounds were fitted: they fill 86 % of the height or of the width. */
export async function projection2(page: Page, [low, high]: [Vec3, Vec3]): Promise<Projection> {
  const { x, y, width, height } = await canvasOf(page);
  const scale = 0.86 * Math.min(width / (high[0] - low[0]), height / (high[1] - low[1]));
  const [cx, cy] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  return (at) => ({ x: x + width / 2 + (at[0] - cx) * scale, y: y + height / 2 - (at[1] - cy) * scale });
}

/** Of a world in 3D with y up: the ball around its bounds touches the edges of a field of 38 degrees. */
export async function projection3(page: Page, [low, high]: [Vec3, Vec3]): Promise<Projection> {
  const { x, y, width, height } = await canvasOf(page);
  const aspect = width / height;
  const camera = new PerspectiveCamera(38, aspect, 0.01, 1000);
  const center = new Vector3(...low).add(new Vector3(...high)).divideScalar(2);
  const radius = new Vector3(...high).distanceTo(new Vector3(...low)) / 2;
  const half = Math.atan(Math.tan((19 * Math.PI) / 180) * Math.min(1, aspect));
  const front = new Vector3(0.55, 0, 1).normalize();
  const direction = front.add(new Vector3(0, 0.42, 0)).normalize();
  camera.position.copy(center).addScaledVector(direction, radius / Math.sin(half));
  camera.lookAt(center);
  camera.updateMatrixWorld();
  return (at) => {
    const device = new Vector3(...at).project(camera);
    return { x: x + ((device.x + 1) / 2) * width, y: y + ((1 - device.y) / 2) * height };
  };
}

/** The box around pixels of the canvas that a test of their colours accepts, in CSS pixels, and their number. */
export interface Silhouette {
  low: Spot;
  high: Spot;
  pixels: number;
}

/** Reads the colours of a screenshot in the page itself, which can decode it. */
export async function silhouette(page: Page, kind: "blue" | "solid"): Promise<Silhouette> {
  const { x, y, width, height } = await canvasOf(page);
  await page.addStyleTag({ content: "#hint, #labels { visibility: hidden }" });
  const picture = await page.screenshot({ clip: { x, y, width, height }, encoding: "base64" });
  const found = await page.evaluate(readPicture, picture, kind);
  const shift = (spot: Spot): Spot => ({ x: spot.x + x, y: spot.y + y });
  return { low: shift(found.low), high: shift(found.high), pixels: found.pixels };
}

/** Runs in the page. Blue is clearly so; solid differs from the almost grey ground by its saturation or its darkness. */
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
