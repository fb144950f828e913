// Small pictures: of the open objects, and of the files that can be opened.
import { effect, signal } from "@preact/signals";
import { objectsOf } from "../content";
import { Blobs, type PageData } from "../data";
import { drawn, view } from "../picture";
import * as page from "../state";
import { refine } from "../texture";
import { View } from "../view";
import { busy, connected, link, objects, onShown, openable, shown } from "./model";
import { Icon } from "./icons";

const [width, height] = [104, 78];
const most = 200000;
/** Pictures of files by name, and of open objects by name; null: there is none. */
const ofFiles = signal<ReadonlyMap<string, HTMLCanvasElement | null>>(new Map());
const ofObjects = signal<ReadonlyMap<string, HTMLCanvasElement>>(new Map());
/** What each picture of an open object shows, so that it is drawn once. */
const pictured = new Map<string, string>();

let spare: View | undefined;

/** Draws the files of the start page, one after the other, while nothing else is under way. */
async function drawFiles() {
  for (const name of openable.value) {
    if (ofFiles.value.has(name)) continue;
    if (objects.value.length > 0 || !connected.value || busy.value) return;
    let picture: HTMLCanvasElement | null = null;
    try {
      const { result, bytes } = await link.ask("preview", { name });
      if (result.content) {
        const data = JSON.parse(result.content) as PageData;
        spare ??= new View(true);
        for (const one of await objectsOf({ data, blobs: new Blobs(bytes, data.blobs) })) {
          await refine(one.shape.look);
          one.paint(() => true, -1, one.colouring("auto"));
          picture = spare.thumbnail(one, width, height);
          one.dispose();
        }
      }
    } catch {
      picture = null; // the file is opened as well without a picture
    }
    ofFiles.value = new Map(ofFiles.value).set(name, picture);
  }
}

/** Draws the open objects that have changed; only where several are open does the list need pictures. */
function drawObjects() {
  if (!view || objects.value.length === 0) return;
  spare?.close();
  spare = undefined;
  const next = new Map<string, HTMLCanvasElement>();
  let changed = false;
  objects.value.forEach((one, i) => {
    const at = shown.value.findIndex((other) => other.object === i);
    const of = drawn[at];
    if (!of) return;
    // Large objects are drawn once, whatever is annotated on them.
    const parts = of.about.faces > most ? "" : of.about.annotations.map((a) => `${a.id} ${a.colour} ${a.faces?.count}`).join();
    const key = `${of.about.shape?.key} ${parts} ${of.about.up}`;
    const before = ofObjects.value.get(one.name);
    if (before && pictured.get(one.name) === key) {
      next.set(one.name, before);
      return;
    }
    if (at !== page.object.value) of.paint(() => true, -1, of.colouring("auto"));
    next.set(one.name, view!.thumbnail(of, width, height));
    pictured.set(one.name, key);
    changed = true;
  });
  if (changed || next.size !== ofObjects.value.size) ofObjects.value = next;
}

onShown.push(() => setTimeout(drawObjects, 60)); // after the first picture
effect(() => {
  if (openable.value.length > 0 && objects.value.length === 0 && connected.value && !busy.value) setTimeout(() => void drawFiles(), 30);
});

function Shown({ picture }: { picture: HTMLCanvasElement | null | undefined }) {
  if (!picture) return <Icon name="object" />;
  return (
    <canvas
      class="thumbnail"
      width={picture.width}
      height={picture.height}
      aria-hidden="true"
      ref={(element) => {
        const context = element?.getContext("2d");
        context?.clearRect(0, 0, picture.width, picture.height);
        context?.drawImage(picture, 0, 0);
      }}
    />
  );
}

export const FileThumbnail = ({ name }: { name: string }) => <Shown picture={ofFiles.value.get(name)} />;
export const ObjectThumbnail = ({ name }: { name: string }) => <Shown picture={ofObjects.value.get(name)} />;
