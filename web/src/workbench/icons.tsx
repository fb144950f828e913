// Icons of tools, panels and commands (Lucide).
import {
  ArrowDownToLine,
  Box,
  Brush,
  CircleQuestionMark,
  Clock,
  FileText,
  Glasses,
  Grip,
  Lasso,
  Layers,
  LayoutGrid,
  MapPin,
  Maximize,
  Mic,
  MousePointer2,
  Move,
  Move3d,
  MoveDiagonal,
  PanelRightClose,
  PanelRightOpen,
  Pentagon,
  Puzzle,
  Redo2,
  Rotate3d,
  Route,
  Ruler,
  Save,
  Scaling,
  Search,
  Spline,
  SquareDashedMousePointer,
  Tags,
  Undo2,
  UnfoldHorizontal,
  Workflow,
  X,
  type IconNode,
} from "lucide";
import { h } from "preact";

const icons = {
  look: MousePointer2,
  base: ArrowDownToLine,
  rectangle: SquareDashedMousePointer,
  lasso: Lasso,
  closed: Pentagon,
  brush: Brush,
  path: Spline,
  points: MapPin,
  ruler: Ruler,
  tape: Route,
  bounding: UnfoldHorizontal,
  handles: Grip,
  move: Move,
  rotate: Rotate3d,
  scale: Scaling,
  stretch: MoveDiagonal,
  annotating: Tags,
  relating: Workflow,
  deforming: Move3d,
  fragments: Puzzle,
  slicing: Layers,
  everything: LayoutGrid,
  results: FileText,
  history: Clock,
  undo: Undo2,
  redo: Redo2,
  save: Save,
  palette: Search,
  voice: Mic,
  enterVr: Glasses,
  tour: CircleQuestionMark,
  fold: PanelRightClose,
  unfold: PanelRightOpen,
  close: X,
  fit: Maximize,
  object: Box,
} satisfies Record<string, IconNode>;

export type IconName = keyof typeof icons;

/** An icon as large as the text around it; its button has the name. */
export function Icon(props: { name: IconName }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true">
      {icons[props.name].map(([tag, attributes], i) => h(tag, { key: i, ...attributes }))}
    </svg>
  );
}
