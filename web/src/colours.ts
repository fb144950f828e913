// Interpolates colours of values between those given by the command.

type Colour = [number, number, number];

export function colourOf(share: number, colours: Colour[]): Colour {
  const at = Math.min(1, Math.max(0, share)) * (colours.length - 1);
  const low = Math.min(colours.length - 2, Math.floor(at));
  return colours[low].map((c, k) => Math.round(c + (at - low) * (colours[low + 1][k] - c))) as Colour;
}

export function gradient(colours: Colour[]): string {
  return `linear-gradient(to right, ${colours.map((c) => `rgb(${c.join(",")})`).join(", ")})`;
}
