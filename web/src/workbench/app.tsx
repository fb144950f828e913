import { effect, signal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import type { Language } from "../data";
import { ColouringChoice } from "../colouring";
import { Picture, drawn, view } from "../picture";
import * as page from "../state";
import { sixViews } from "../view";
import { canListen, commands, gazed, heard, listen, listening, palette, say } from "./commands";
import { Arriving, ChooseFiles } from "./drop";
import * as model from "./model";
import { Annotating, Deforming, Everything, Fragments, History, Relations, Results, Slicing } from "./panels";
import { brushRadius, choose, clicked, Drawing, finish, groups, measureName, picked, radius, tool } from "./tools";
import { text, type Key } from "./words";
import { canEnter, enter } from "./xr";

const tabs = ["annotating", "relating", "deforming", "fragments", "slicing", "everything", "results", "history"] as const;
export const tab = signal<(typeof tabs)[number]>("annotating");
const panels = {
  annotating: Annotating,
  relating: Relations,
  deforming: Deforming,
  fragments: Fragments,
  slicing: Slicing,
  everything: Everything,
  results: Results,
  history: History,
};

function Header() {
  const [name, setName] = useState("");
  const { place, history, openable } = model;
  return (
    <header>
      <h1>Ostraka</h1>
      <label>
        {text("open")}{" "}
        <select
          value=""
          onChange={(event) => {
            const file = event.currentTarget.value;
            if (file) void model.change("open", "open", { name: file });
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
      <button type="button" disabled={place.value === 0} onClick={() => void model.undo()}>
        {text("undo")}
      </button>
      <button type="button" disabled={place.value === history.value.length} onClick={() => void model.redo()}>
        {text("redo")}
      </button>
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
        <label>
          {text("saveAs")} <input class="narrow" value={name} required onInput={(event) => setName(event.currentTarget.value)} />
        </label>
        <button type="submit" disabled={!model.object.value}>
          {text("save")}
        </button>
      </form>
      <button type="button" onClick={() => (palette.value = true)} title="Ctrl+K">
        {text("palette")}
      </button>
      {canListen() && (
        <button type="button" aria-pressed={listening.value} onClick={() => listen(!listening.value)}>
          {text("voice")}
        </button>
      )}
      {canEnter.value && (
        <button type="button" disabled={!model.object.value} onClick={() => void enter()}>
          {text("enterVr")}
        </button>
      )}
      <button type="button" onClick={() => (tour.value = 0)}>
        {text("tour")}
      </button>
      <label>
        {page.word("language")}{" "}
        <select value={page.language.value} onChange={(event) => page.setLanguage(event.currentTarget.value as Language)}>
          <option value="en">English</option>
          <option value="de">Deutsch</option>
          <option value="it">Italiano</option>
        </select>
      </label>
      <label>
        {page.word("theme")}{" "}
        <select value={page.theme.value} onChange={(event) => page.setTheme(event.currentTarget.value)}>
          {(["system", "light", "dark"] as const).map((one) => (
            <option key={one} value={one}>
              {page.word(one)}
            </option>
          ))}
        </select>
      </label>
    </header>
  );
}

function Tools() {
  const of = drawn[page.object.value];
  return (
    <div class="tools" role="toolbar" aria-label={text("tools")} aria-orientation="vertical">
      {groups.map(([name, list]) => (
        <div class="group" key={name}>
          {name !== "look" && <span class="quiet">{text(name)}</span>}
          {list.map((one) => (
            <button
              key={one}
              type="button"
              data-tool={one}
              aria-pressed={tool.value === one}
              title={text(`${one}Help` as Key)}
              onClick={() => choose(one)}
            >
              {text(one as Key)}
            </button>
          ))}
        </div>
      ))}
      {tool.value === "brush" && of && (
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
      {["ruler", "tape", "bounding"].includes(tool.value) && (
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

function Layers() {
  const { objects, active } = model;
  if (objects.value.length === 0) return null;
  return (
    <fieldset class="layers">
      <legend>{text("objects")}</legend>
      {objects.value.map((one, i) => (
        <span key={one.name} class="layer">
          <label>
            <input
              type="radio"
              name="active"
              checked={i === active.value}
              onChange={() => void model.change("activate", "activate", { object: i })}
            />{" "}
            {one.name}
          </label>
          {i !== active.value && (
            <label>
              <input
                type="checkbox"
                checked={model.layers.value.has(one.name)}
                onChange={(event) => {
                  const next = new Set(model.layers.value);
                  if (event.currentTarget.checked) next.add(one.name);
                  else next.delete(one.name);
                  model.layers.value = next;
                }}
              />{" "}
              {text("showWith")}
            </label>
          )}
          <button
            type="button"
            aria-label={`${text("close")}: ${one.name}`}
            onClick={() => void model.change("close", "close", { object: i })}
          >
            ×
          </button>
        </span>
      ))}
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
      <span class="group">
        <button type="button" onClick={() => view?.home()}>
          {page.word("fit")}
        </button>
        {sixViews.map(([name, azimuth, elevation]) => (
          <button key={name} type="button" onClick={() => view?.look(azimuth, elevation)}>
            {page.word(name)}
          </button>
        ))}
      </span>
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
        {text("drawnAs")}{" "}
        <select value={model.drawnAs.value} onChange={(event) => (model.drawnAs.value = event.currentTarget.value as "surface")}>
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

function Footer() {
  const about = page.page.objects[page.object.value];
  const now = model.progress.value;
  return (
    <footer>
      <span role="status">
        {about
          ? `${about.name}: ${page.numberText(about.vertices)} ${page.word("vertices")}, ${page.numberText((3 * about.faces) / 2)} ${text("edges")}, ${page.numberText(about.faces)} ${page.word("faces")}` +
            (about.cage ? `; ${text("cageOf", about.cage.vertices)}` : "")
          : text("nothingOpen")}
        {page.message.value && ` – ${page.message.value}`}
      </span>
      {!model.connected.value && <strong class="verdict broken">{text("notConnected")}</strong>}
      {model.busy.value && (
        <span class="busy">
          {model.busy.value} … {now && `${now.phase} ${Math.round(100 * now.share)} %`} <progress max={1} value={now?.share} />
          <button type="button" onClick={() => model.link.cancel()}>
            {text("cancel")}
          </button>
        </span>
      )}
      {model.problem.value && (
        <span role="alert" class="problem">
          {model.problem.value.problem}
          {model.problem.value.remedy && `: ${model.problem.value.remedy}`}{" "}
          <button type="button" aria-label={text("close")} onClick={() => (model.problem.value = undefined)}>
            ×
          </button>
        </span>
      )}
    </footer>
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
  return (
    <>
      <Header />
      <main class="workbench">
        <Tools />
        <div class="left">
          <ViewBar key={turn} />
          <div class="canvas">
            {view && <Picture key={turn} />}
            {view && <Drawing key={-turn} />}
            <Chooser />
            <Arriving />
          </div>
          <Layers />
          {heard.value && <p class="quiet">{text("heard", heard.value)}</p>}
        </div>
        <aside tabIndex={0} aria-label={text("panels")}>
          <div class="tabs" role="tablist">
            {tabs.map((one) => (
              <button
                key={one}
                type="button"
                role="tab"
                id={`tab-${one}`}
                aria-selected={tab.value === one}
                aria-controls="panel"
                onClick={() => (tab.value = one)}
              >
                {text(one)}
              </button>
            ))}
          </div>
          <div id="panel" role="tabpanel" aria-labelledby={`tab-${tab.value}`}>
            {page.page.objects.length > 0 || tab.value === "history" || tab.value === "everything" ? (
              <Panel key={`${tab.value} ${turn}`} />
            ) : (
              <p class="quiet">{text("nothingOpen")}</p>
            )}
          </div>
        </aside>
      </main>
      <Footer key={turn} />
      <Pointed key={turn} />
      <Palette />
      <Tour />
    </>
  );
}
