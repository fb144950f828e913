// Colours of values: those of the command's own pictures (viridis; blue to red through white about zero).
const stops = {
  rising: ["#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6dcd59", "#b4de2c", "#fde725"],
  diverging: ["#2166ac", "#67a9cf", "#d1e5f0", "#f7f7f7", "#fddbc7", "#ef8a62", "#b2182b"],
};

export function colourOf(share: number, diverging: boolean): [number, number, number] {
  const list = diverging ? stops.diverging : stops.rising;
  const at = Math.min(1, Math.max(0, share)) * (list.length - 1);
  const low = Math.min(list.length - 2, Math.floor(at));
  const part = (hex: string, k: number) => parseInt(hex.slice(1 + 2 * k, 3 + 2 * k), 16);
  return [0, 1, 2].map((k) => Math.round(part(list[low], k) + (at - low) * (part(list[low + 1], k) - part(list[low], k)))) as [
    number,
    number,
    number,
  ];
}

export function gradient(diverging: boolean): string {
  return `linear-gradient(to right, ${(diverging ? stops.diverging : stops.rising).join(", ")})`;
}
