import { effect, signal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import type { Language } from "../data";
import { ColouringChoice } from "../colouring";
import { Picture, drawn, view } from "../picture";
import * as page from "../state";
import { canListen, commands, gazed, heard, listen, listening, palette, redoLast, say, undoLast } from "./commands";
import * as deform from "./deform";
import { Arriving, ChooseFiles } from "./drop";
import { Gizmo } from "./gizmo";
import { FirstQuestions } from "./first";
import { Icon, type IconName } from "./icons";
import { Light } from "../light";
import * as model from "./model";
import { savePicture } from "../snapshot";
import { makePage, makePlate } from "./products";
import { Measuring } from "./measuring";
import { Annotating, Deforming, Everything, Fragments, History, PartEditor, Relations, Results, Slicing } from "./panels";
import { folded, remediesOf, tab, tabs, withoutCommands } from "./remedies";
import { FileThumbnail, ObjectThumbnail } from "./thumbnails";
import * as selection from "./selection";
import { brushRadius, choose, clicked, Drawing, finish, groups, measureName, picked, radius, tool } from "./tools";
import { text, type Key } from "./words";
import { canEnter, enter } from "./xr";

/** The panel's width in pixels. */
const panelWidth = signal(268);
const panels = {
  annotating: Annotating,
  measuring: Measuring,
  relating: Relations,
  deforming: Deforming,
  fragments: Fragments,
  slicing: Slicing,
  everything: Everything,
  results: Results,
  history: History,
};

/** A button with an icon; its name is shown where the pointer rests on it, and read aloud. */
function IconButton(props: { icon: IconName; name: string; hint?: string; disabled?: boolean; pressed?: boolean; onClick: () => void }) {
  return (
    <button
      type="button"
      class="icon-button"
      aria-label={props.name}
      title={props.hint ?? props.name}
      disabled={props.disabled}
      aria-pressed={props.pressed}
      onClick={props.onClick}
    >
      <Icon name={props.icon} />
    </button>
  );
}

const openFile = (name: string) => void model.change("open", "open", { name });

function Header() {
  const [name, setName] = useState("");
  const { place, history, openable } = model;
  return (
    <header>
      <h1>Ostraka</h1>
      <label class="open">
        {text("open")}{" "}
        <select
          value=""
          onChange={(event) => {
            const file = event.currentTarget.value;
            if (file) openFile(file);
            event.currentTarget.value = "";
          }}
        >
          <option value="">…</option>
          {openable.value.map((one) => (
            <option key={one} value={one}>
              {one}
            </option>
          ))}
        </select>
      </label>
      <ChooseFiles />
      <span class="group">
        <IconButton
          icon="undo"
          name={text("undo")}
          hint={`${text("undo")} (Ctrl+Z)`}
          disabled={place.value === 0 && selection.strokes.value === 0}
          onClick={undoLast}
        />
        <IconButton
          icon="redo"
          name={text("redo")}
          hint={`${text("redo")} (Ctrl+Y)`}
          disabled={place.value === history.value.length}
          onClick={redoLast}
        />
      </span>
      <form
        class="save"
        onSubmit={(event) => {
          event.preventDefault();
          void model.attempt(text("save"), async () => {
            const { result } = await model.link.ask("save", { name });
            page.message.value = text("saved", result.file);
          });
        }}
      >
        <input
          class="narrow"
          aria-label={text("saveAs")}
          placeholder={text("saveAs")}
          value={name}
          required
          onInput={(event) => setName(event.currentTarget.value)}
        />
        <button type="submit" class="icon-button" aria-label={text("save")} title={text("save")} disabled={!model.object.value}>
          <Icon name="save" />
        </button>
      </form>
      <Products />
      <span class="group">
        <IconButton icon="palette" name={text("palette")} hint={`${text("palette")} (Ctrl+K)`} onClick={() => (palette.value = true)} />
        {canListen() && <IconButton icon="voice" name={text("voice")} pressed={listening.value} onClick={() => listen(!listening.value)} />}
        {canEnter.value && <IconButton icon="enterVr" name={text("enterVr")} disabled={!model.object.value} onClick={() => void enter()} />}
        <IconButton icon="tour" name={text("tour")} onClick={() => (tour.value = 0)} />
      </span>
      <select
        aria-label={page.word("language")}
        value={page.language.value}
        onChange={(event) => page.setLanguage(event.currentTarget.value as Language)}
      >
        <option value="en">English</option>
        <option value="de">Deutsch</option>
        <option value="it">Italiano</option>
      </select>
      <select aria-label={page.word("theme")} value={page.theme.value} onChange={(event) => page.setTheme(event.currentTarget.value)}>
        {(["system", "light", "dark"] as const).map((one) => (
          <option key={one} value={one}>
            {page.word(one)}
          </option>
        ))}
      </select>
      <IconButton
        icon={folded.value ? "unfold" : "fold"}
        name={text(folded.value ? "showPanel" : "hidePanel")}
        onClick={() => (folded.value = !folded.value)}
      />
    </header>
  );
}

function Tools() {
  return (
    <div class="tools" role="toolbar" aria-label={text("tools")} aria-orientation="vertical">
      {groups.map(([name, list]) => (
        <div class="group" key={name} role="group" aria-label={text(name)}>
          {list.map((one) => (
            <button
              key={one}
              type="button"
              data-tool={one}
              aria-pressed={tool.value === one}
              title={`${text(one as Key)}: ${text(`${one}Help` as Key)}`}
              onClick={() => {
                choose(one);
                if (name === "measure") tab.value = "measuring";
                else if (name === "select" && tab.value === "measuring") tab.value = "annotating";
              }}
            >
              <Icon name={one} />
              <span>{text(one as Key)}</span>
            </button>
          ))}
        </div>
      ))}
    </div>
  );
}

/** What the next click does, in words. */
function nextHint(hasCage: boolean): Key {
  const t = tool.value;
  const count = picked.value.length;
  if (t === "ruler") return count === 0 ? "rulerHelp" : "nextEnd";
  if (t === "angle") return (["angleHelp", "nextApex", "nextLeg"] as const)[Math.min(2, count)];
  if ((t === "tape" || t === "path") && count > 0) return count === 1 ? "nextPoint" : "nextPointOrEnd";
  if (t === "closed" && count > 0) return count < 3 ? "nextPoint" : "nextInside";
  if (selection.selected.value && ["rectangle", "lasso", "brush", "closed", "path", "points"].includes(t))
    return selection.erases.value ? "nextErase" : "nextMore";
  if (["move", "rotate", "scale", "stretch"].includes(t) && hasCage && deform.handles.value.size === 0) return "nextHandles";
  if (["move", "rotate", "scale", "stretch"].includes(t) && !hasCage) return "nextWhole";
  return `${t}Help` as Key;
}

/** What the next click does with the chosen tool, and the settings of the tool. */
function ToolHint() {
  const of = drawn[page.object.value];
  if (!of) return null;
  return (
    <div class="hint">
      <span>{text(nextHint(of.about.cage !== undefined))}</span>
      {tool.value === "brush" && (
        <label>
          {text("radius")}{" "}
          <input
            type="number"
            step="any"
            min="0"
            placeholder={String(brushRadius(of))}
            value={radius.value || ""}
            onInput={(event) => (radius.value = +event.currentTarget.value)}
          />
        </label>
      )}
      {["ruler", "tape", "angle", "bounding"].includes(tool.value) && (
        <label>
          {text("name")} <input value={measureName.value} onInput={(event) => (measureName.value = event.currentTarget.value)} />
        </label>
      )}
      {picked.value.length > 0 && (
        <button type="button" onClick={() => void finish()}>
          {text("finishPicks")} ({picked.value.length})
        </button>
      )}
    </div>
  );
}

/** The open objects: which one is worked on, which others are drawn with it. */
function Layers() {
  const { objects, active } = model;
  void page.turn.value; // the counts are those of the shown content
  if (objects.value.length === 0) return null;
  return (
    <fieldset class="layers">
      <legend>{text("objects")}</legend>
      <ul>
        {objects.value.map((one, i) => {
          const about = page.page.objects[model.shown.value.findIndex((other) => other.object === i)];
          return (
            <li
              key={one.name}
              class={i === active.value ? "layer active" : "layer"}
              ref={(element) => {
                // The list alone scrolls to the active object.
                if (i === active.value && element?.parentElement)
                  element.parentElement.scrollTop = element.offsetTop - element.parentElement.offsetTop - 8;
              }}
            >
              <label>
                <input
                  type="radio"
                  name="active"
                  checked={i === active.value}
                  onChange={() => void model.change("activate", "activate", { object: i })}
                />
                <ObjectThumbnail name={one.name} />
                <strong>{one.name}</strong>
                {about && (
                  <small>
                    {page.numberText(about.faces)} {page.word("faces")}
                    {about.annotations.length > 0 && `, ${about.annotations.length} ${text("annotating").toLocaleLowerCase()}`}
                    {one.parts.cage && `, ${text("cage").toLocaleLowerCase()}`}
                  </small>
                )}
              </label>
              {i !== active.value && (
                <IconButton
                  icon="showWith"
                  name={`${text("showWith")}: ${one.name}`}
                  pressed={model.layers.value.has(one.name)}
                  onClick={() => {
                    const next = new Set(model.layers.value);
                    if (!next.delete(one.name)) next.add(one.name);
                    model.layers.value = next;
                  }}
                />
              )}
              <button
                type="button"
                class="icon-button"
                aria-label={`${text("close")}: ${one.name}`}
                onClick={() => void model.change("close", "close", { object: i })}
              >
                <Icon name="close" />
              </button>
            </li>
          );
        })}
      </ul>
      {model.shown.value.length > 1 && (
        <label>
          <input
            type="checkbox"
            checked={page.sideBySide.value}
            onChange={(event) => (page.sideBySide.value = event.currentTarget.checked)}
          />{" "}
          {page.word("sideBySide")}
        </label>
      )}
    </fieldset>
  );
}

/** Updates the comparison of the shape before and after the deformation. */
effect(() => {
  const share = model.compare.value;
  void page.turn.value;
  if (!view) return;
  const rest = model.shown.value.findIndex((one) => one.object === model.active.value && !one.deformed);
  const deformed = model.shown.value.findIndex((one) => one.object === model.active.value && one.deformed);
  const [left, right] = [drawn[rest], drawn[deformed]];
  view.wipe = share !== undefined && left && right ? { left, right, share } : undefined;
  if (view.wipe) left.paint(() => true, -1, left.colouring(page.colouring.value));
  view.draw();
});

/** The line between the shape before and after the deformation: dragged, or moved by arrow keys. */
function Wipe() {
  const share = model.compare.value;
  if (share === undefined || !model.has("deformed")) return null;
  const put = (value: number) => (model.compare.value = Math.min(0.98, Math.max(0.02, value)));
  return (
    <div
      class="wipe"
      role="slider"
      aria-label={text("compare")}
      aria-valuemin={0}
      aria-valuemax={100}
      aria-valuenow={Math.round(100 * share)}
      tabIndex={0}
      ref={(element) => void (element && (element.style.left = `${100 * share}%`))}
      onKeyDown={(event) => {
        if (event.key === "ArrowLeft") put(share - 0.02);
        if (event.key === "ArrowRight") put(share + 0.02);
      }}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={(event) => {
        if (!event.currentTarget.hasPointerCapture(event.pointerId)) return;
        const box = event.currentTarget.parentElement!.getBoundingClientRect();
        put((event.clientX - box.left) / box.width);
      }}
    >
      <span class="before">{page.word("before")}</span>
      <span class="after">{page.word("after")}</span>
    </div>
  );
}

/** The buttons that make something to take away: a picture, a plate for print, a page for a colleague. */
function Products() {
  const isOpen = model.object.value !== undefined;
  return (
    <span class="group products">
      <button
        type="button"
        disabled={!isOpen}
        title={text("pictureHelp")}
        onClick={() => view && savePicture(view, model.object.value!.name)}
      >
        <Icon name="picture" /> {text("picture")}
      </button>
      <button type="button" disabled={!isOpen} title={text("plateHelp")} onClick={() => void makePlate()}>
        <Icon name="plate" /> {text("plate")}
      </button>
      <button type="button" disabled={!isOpen} title={text("pageHelp")} onClick={() => void makePage()}>
        <Icon name="page" /> {text("makePage")}
      </button>
    </span>
  );
}

/** Updates the layers beside the active object, and the drawing style. */
effect(() => {
  const names = model.layers.value;
  const style = model.drawnAs.value;
  const of = drawn[page.object.value];
  void page.turn.value;
  if (!view || !of) return;
  const list = drawn.filter((one, i) => {
    const about = model.shown.value[i];
    if (!about || one === of || about.object === model.active.value) return false;
    const last = !model.shown.value.some((other, k) => k > i && other.object === about.object); // prefers the deformed state, if there is one
    return last && names.has(model.objects.value[about.object]?.name);
  });
  for (const one of list) one.paint(() => true, -1, one.colouring(page.colouring.value));
  for (const one of drawn) one.style(style);
  view.showWith(of, list);
});

function ViewBar() {
  return (
    <div class="toolbar" role="toolbar" aria-label={page.word("view")}>
      <IconButton icon="fit" name={page.word("fit")} hint={`${page.word("fit")} (0)`} onClick={() => view?.home()} />
      <label class="slider">
        {page.word("clip")}{" "}
        <input
          type="range"
          min={-1}
          max={1}
          step={0.01}
          value={page.clip.value}
          onInput={(event) => (page.clip.value = +event.currentTarget.value)}
        />
      </label>
      <label>
        {page.word("clipAxis")}{" "}
        <select value={String(page.clipAxis.value)} onChange={(event) => (page.clipAxis.value = +event.currentTarget.value)}>
          {["x", "y", "z"].map((one, i) => (
            <option key={one} value={String(i)}>
              {one}
            </option>
          ))}
        </select>
      </label>
      <label>
        <select
          aria-label={text("drawnAs")}
          title={text("drawnAs")}
          value={model.drawnAs.value}
          onChange={(event) => (model.drawnAs.value = event.currentTarget.value as "surface")}
        >
          <option value="surface">{text("surface")}</option>
          <option value="edges">{text("wire")}</option>
          <option value="points">{text("cloud")}</option>
        </select>
      </label>
      <ColouringChoice />
      {(
        [
          ["cage", page.cage, page.word("cage")],
          ["patterns", page.patterns, page.word("patterns")],
          ["labels", page.labels, page.word("labels")],
        ] as const
      ).map(([key, which, label]) => (
        <label key={key}>
          <input type="checkbox" checked={which.value} onChange={(event) => (which.value = event.currentTarget.checked)} /> {label}
        </label>
      ))}
    </div>
  );
}

/** Lets the user choose among several annotations at the clicked position. */
function Chooser() {
  const at = clicked.value;
  const about = page.page.objects[page.object.value];
  if (!at || !about || at.list.length < 2) return null;
  return (
    <div class="chooser" role="group" aria-label={text("whichOne")} style={{ left: `${at.x + 10}px`, top: `${at.y + 10}px` }}>
      {at.list.map((i) => (
        <button
          key={i}
          type="button"
          aria-pressed={page.chosen.value === i}
          onClick={() => {
            page.choose(i);
            clicked.value = undefined;
          }}
        >
          {about.annotations[i]?.tag || `#${about.annotations[i]?.id}`}
        </button>
      ))}
    </div>
  );
}

/** Makes the annotation under the pointer the target of "select". */
function Pointed() {
  const first = page.hovered.value?.annotations[0] ?? -1;
  useEffect(() => {
    gazed.value = first;
  }, [first]);
  return null;
}

/** The buttons that do what a problem or a note asks for. */
function Remedies({ said }: { said: string }) {
  const list = remediesOf(said);
  if (list.length === 0) return null;
  return (
    <div class="buttons">
      {list.map((one) => (
        <button
          key={one.label}
          type="button"
          class="remedy"
          onClick={() => {
            model.problem.value = undefined;
            one.action();
          }}
        >
          {one.label}
        </button>
      ))}
    </div>
  );
}

/** What the command noted when the object was opened, folded. */
function OpeningNotes() {
  const name = model.object.value?.name ?? "";
  const list = model.notes.value.get(name);
  if (!list || list.length === 0) return null;
  return (
    <div class="counts notes">
      <details>
        <summary>{list.length === 1 ? text("noteOf", name) : text("notesOf", list.length, name)}</summary>
        <ul>
          {list.map((one) => (
            <li key={one}>{withoutCommands(one)}</li>
          ))}
        </ul>
      </details>
      <Remedies said={list.find((one) => /mesh repair/.test(one)) ?? ""} />
    </div>
  );
}

/** Counts of the object, work in progress, errors and their remedies, a lost connection: at one place in the picture. */
function Notices() {
  const about = page.page.objects[page.object.value];
  const now = model.progress.value;
  return (
    <div class="notices">
      {!model.connected.value && (
        <p role="alert" class="notice problem">
          {text("notConnected")}
        </p>
      )}
      {model.problem.value && (
        <div role="alert" class="notice problem">
          <div>
            <strong>{withoutCommands(model.problem.value.problem)}</strong>
            {withoutCommands(model.problem.value.remedy) && <p>{withoutCommands(model.problem.value.remedy)}</p>}
            <Remedies said={`${model.problem.value.problem}; ${model.problem.value.remedy}`} />
          </div>
          <IconButton icon="close" name={text("close")} onClick={() => (model.problem.value = undefined)} />
        </div>
      )}
      {model.busy.value && (
        <div class="notice busy">
          <span>
            {model.busy.value} … {now && `${now.phase} ${Math.round(100 * now.share)} %`}
          </span>
          <progress aria-label={model.busy.value} max={1} value={now?.share} />
          <button type="button" onClick={() => model.link.cancel()}>
            {text("cancel")}
          </button>
        </div>
      )}
      <PartEditor />
      <ToolHint />
      <OpeningNotes />
      <p role="status" class="counts">
        {about
          ? `${about.name}: ${page.numberText(about.vertices)} ${page.word("vertices")}, ${page.numberText((3 * about.faces) / 2)} ${text("edges")}, ${page.numberText(about.faces)} ${page.word("faces")}` +
            (about.cage ? `; ${text("cageOf", about.cage.vertices)}` : "")
          : text("nothingOpen")}
        {page.message.value && ` – ${page.message.value}`}
      </p>
    </div>
  );
}

/** What is shown before an object is open: the files that can be opened. */
function Start() {
  return (
    <section class="start" aria-labelledby="start-title">
      <h2 id="start-title">{text("startTitle")}</h2>
      <p>{text(model.openable.value.length > 0 ? "startHelp" : "startEmpty")}</p>
      <p class="buttons">
        <ChooseFiles />
        {model.history.value.length > model.place.value && (
          <button type="button" onClick={() => void model.goTo(model.history.value.length)}>
            <Icon name="history" /> {text("goOn", model.history.value.length)}
          </button>
        )}
      </p>
      <ul>
        {model.openable.value.map((one) => (
          <li key={one}>
            <button type="button" onClick={() => openFile(one)}>
              <FileThumbnail name={one} /> <span>{one}</span>
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}

/** The edge of the panel: dragged, or moved by arrow keys, it makes the panel wider or narrower. */
function Divider() {
  const wide = (pixels: number) => (panelWidth.value = Math.round(Math.min(0.6 * window.innerWidth, Math.max(240, pixels))));
  return (
    <div
      class="divider"
      role="separator"
      aria-orientation="vertical"
      aria-label={text("panelWidth")}
      aria-valuenow={panelWidth.value}
      aria-valuemin={240}
      aria-valuemax={Math.round(0.6 * window.innerWidth)}
      tabIndex={0}
      onKeyDown={(event) => {
        if (event.key === "ArrowLeft") wide(panelWidth.value + 20);
        if (event.key === "ArrowRight") wide(panelWidth.value - 20);
      }}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={(event) => {
        if (event.currentTarget.hasPointerCapture(event.pointerId)) wide(window.innerWidth - event.clientX);
      }}
    />
  );
}

function Palette() {
  const input = useRef<HTMLInputElement>(null);
  const [said, setSaid] = useState("");
  // Before the next key event, so that text typed right after Ctrl+K goes here.
  useLayoutEffect(() => {
    if (palette.value) input.current?.focus();
    else setSaid("");
  }, [palette.value]);
  if (!palette.value) return null;
  const words = said.trim().toLocaleLowerCase();
  const list = commands.filter((one) => text(one.words).toLocaleLowerCase().includes(words.replace(/ \d+$/, "")));
  const close = () => (palette.value = false);
  return (
    <div
      class="palette"
      role="dialog"
      aria-modal="true"
      aria-label={text("palette")}
      onKeyDown={(event) => {
        if (event.key === "Escape") close();
      }}
    >
      <form
        onSubmit={(event) => {
          event.preventDefault();
          if (!say(said)) list[0]?.action();
          close();
        }}
      >
        <input ref={input} aria-label={text("palette")} value={said} onInput={(event) => setSaid(event.currentTarget.value)} />
      </form>
      <ul>
        {list.slice(0, 14).map((one) => (
          <li key={one.id}>
            <button
              type="button"
              class="plain"
              onClick={() => {
                one.action();
                close();
              }}
            >
              {text(one.words)}
              {one.takesNumber ? " 1, 2, …" : ""} <span class="quiet">{one.key ?? ""}</span>
            </button>
          </li>
        ))}
      </ul>
    </div>
  );
}

const tour = signal(-1);
const steps = 6;
function Tour() {
  const at = tour.value;
  if (at < 0) return null;
  return (
    <div class="tour" role="dialog" aria-label={text("tour")}>
      <p>{text(`tour${at + 1}` as Key)}</p>
      <div class="buttons">
        <button type="button" onClick={() => (tour.value = -1)}>
          {text("close")}
        </button>
        <button type="button" disabled={at === 0} onClick={() => (tour.value = at - 1)}>
          {text("previous")}
        </button>
        <button type="button" disabled={at === steps - 1} onClick={() => (tour.value = at + 1)}>
          {text("next")}
        </button>
      </div>
    </div>
  );
}

export function App() {
  const Panel = panels[tab.value];
  const turn = page.turn.value; // recompute for another content
  const isEmpty = page.page.objects.length === 0;
  return (
    <>
      <Header />
      <main
        class={folded.value ? "workbench folded" : "workbench"}
        ref={(element) => element?.style.setProperty("--panel-width", `${panelWidth.value}px`)}
      >
        <Tools />
        <div class="canvas">
          {view && !isEmpty && <Picture key={turn} />}
          {view && !isEmpty && <Drawing key={-turn} />}
          {isEmpty ? <Start /> : <ViewBar key={turn} />}
          {!isEmpty && (
            <div class="corner">
              <Gizmo />
              <Light />
            </div>
          )}
          <Wipe />
          <Chooser />
          <Arriving />
          {heard.value && <p class="quiet heard">{text("heard", heard.value)}</p>}
          <Notices key={`notices ${turn}`} />
        </div>
        {!folded.value && (
          <>
            <Divider />
            <aside tabIndex={0} aria-label={text("panels")}>
              <div class="tabs" role="tablist">
                {tabs.map((one) => (
                  <button
                    key={one}
                    type="button"
                    role="tab"
                    id={`tab-${one}`}
                    aria-label={text(one)}
                    title={text(one)}
                    aria-selected={tab.value === one}
                    aria-controls="panel"
                    onClick={() => (tab.value = one)}
                  >
                    <Icon name={one} />
                  </button>
                ))}
              </div>
              <Layers />
              <FirstQuestions key={`first ${turn}`} />
              <div id="panel" role="tabpanel" aria-labelledby={`tab-${tab.value}`}>
                <h2 class="panel-title">{text(tab.value)}</h2>
                {!isEmpty || tab.value === "history" || tab.value === "everything" ? (
                  <Panel key={`${tab.value} ${turn}`} />
                ) : (
                  <p class="quiet">{text("nothingOpen")}</p>
                )}
              </div>
            </aside>
          </>
        )}
      </main>
      <Pointed key={turn} />
      <Palette />
      <Tour />
    </>
  );
}
