// The picture as it is seen, with scale bar, names and measures, as an image file.
import type { View } from "./view";

/** Draws an element of the overlay as the page shows it. */
function drawElement(context: CanvasRenderingContext2D, element: SVGElement) {
  const style = getComputedStyle(element);
  const number = (name: string) => Number(element.getAttribute(name) ?? 0);
  context.globalAlpha = Number(style.opacity);
  context.fillStyle = style.fill;
  context.strokeStyle = style.stroke;
  context.lineWidth = Number.parseFloat(style.strokeWidth) || 1;
  context.setLineDash(style.strokeDasharray === "none" ? [] : style.strokeDasharray.split(",").map(Number.parseFloat));
  const fills = style.fill !== "none";
  const strokes = style.stroke !== "none";
  if (element.tagName === "text") {
    context.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
    context.textAlign = ({ middle: "center", end: "right" } as const)[style.textAnchor as "middle"] ?? "left";
    context.lineJoin = "round";
    const said = element.textContent ?? "";
    if (strokes) context.strokeText(said, number("x"), number("y"));
    if (fills) context.fillText(said, number("x"), number("y"));
    return;
  }
  const path = new Path2D(element.getAttribute("d") ?? undefined);
  if (element.tagName === "line") {
    path.moveTo(number("x1"), number("y1"));
    path.lineTo(number("x2"), number("y2"));
  }
  if (element.tagName === "circle") path.arc(number("cx"), number("cy"), number("r"), 0, 2 * Math.PI);
  if (fills && element.tagName !== "line") context.fill(path);
  if (strokes) context.stroke(path);
}

/** The view and its overlay at the resolution of the screen. */
export function snapshot(view: View): HTMLCanvasElement {
  view.paint();
  view.onMove();
  const { canvas } = view;
  const picture = document.createElement("canvas");
  Object.assign(picture, { width: canvas.width, height: canvas.height });
  const context = picture.getContext("2d")!;
  context.fillStyle = `#${view.background.toString(16).padStart(6, "0")}`;
  context.fillRect(0, 0, picture.width, picture.height);
  context.drawImage(canvas, 0, 0);
  const scale = canvas.width / Math.max(1, canvas.clientWidth);
  context.scale(scale, scale);
  for (const one of canvas.parentElement?.querySelectorAll<SVGElement>(":scope > svg > *") ?? []) drawElement(context, one);
  return picture;
}

/** Saves the picture as a PNG file. */
export function savePicture(view: View, name: string) {
  snapshot(view).toBlob((blob) => {
    if (!blob) return;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${name.replace(/[^\p{L}\p{N}._-]+/gu, "-")}.png`;
    link.click();
    URL.revokeObjectURL(link.href);
  }, "image/png");
}
