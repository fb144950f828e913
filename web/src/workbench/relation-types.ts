// The types of relationships in groups, and the parameters of each as constraints (doc/deformation.md, "Constraints").

export interface Parameter {
  name: string;
  kind: "number" | "word" | "vector" | "follow" | "measure";
  words?: string[];
  minimum?: number;
  maximum?: number;
}

const direction: Parameter = { name: "direction", kind: "vector" };
const point: Parameter = { name: "point", kind: "vector" };
const follow: Parameter = { name: "follow", kind: "follow" };
const mode: Parameter = { name: "mode", kind: "word", words: ["stretch", "scale"] };
const measure = (name = "measure"): Parameter => ({ name, kind: "measure" });
const range: Parameter[] = [
  { name: "minValue", kind: "number", minimum: 0 },
  { name: "maxValue", kind: "number", minimum: 0 },
];

export const parametersOf: Record<string, Parameter[]> = {
  "keep shape": [{ name: "mode", kind: "word", words: ["rigid", "similar", "seat"] }],
  "same level": [
    { name: "heights", kind: "word", words: ["rest", "equal"] },
    { name: "shapes", kind: "word", words: ["keep", "similar", "free", "seat"] },
    { name: "reference", kind: "word", words: ["mean", "base", "vertex"] },
    direction,
    follow,
  ],
  "structural continuity": [{ name: "angle", kind: "number", minimum: 0.1, maximum: 90 }],
  proportion: [measure("measure1"), measure("measure2"), ...range, mode, follow],
  "keep measure": [measure(), ...range, mode],
  "same measure": [measure(), mode, follow],
  "mirror symmetry": [direction, point, follow],
  "keep direction": [direction, { name: "angle", kind: "number", minimum: 0, maximum: 90 }],
  "keep position": [point],
  "horizontal support": [direction],
  "side contact": [direction],
  "part similarity": [follow],
  "same length": [follow],
  "equal attributes": [mode, follow],
};

export const typeGroups = {
  groupLevel: ["same level", "keep position", "keep direction", "horizontal support", "side contact"],
  groupSize: ["keep shape", "keep measure", "same measure", "same length", "proportion", "part similarity", "equal attributes"],
  groupAxes: [
    "mirror symmetry",
    "co-axiality",
    "parallel axes",
    "perpendicular axes",
    "co-linearity",
    "co-planarity",
    "structural continuity",
  ],
  groupParts: ["adjacency", "containment", "equal selections"],
} as const;

const grouped = new Set<string>(Object.values(typeGroups).flat());
/** The solver's kinds: types in no group, whose parameters are given as JSON. */
export const isGrouped = (type: string) => grouped.has(type);
