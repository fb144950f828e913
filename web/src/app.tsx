import { gradient } from "./colours";
import { Index } from "./collection";
import { ColouringChoice } from "./colouring";
import { Light } from "./light";
import { Conformance, Constraints } from "./constraints";
import type { Language } from "./data";
import { Details } from "./details";
import { Graph } from "./graph";
import { Legend } from "./legend";
import { address, closeEntry } from "./content";
import { Picture, view } from "./picture";
import { sixViews } from "./view";
import { Slices } from "./slices";
import { savePicture } from "./snapshot";
import * as state from "./state";
import { numberText, page, word } from "./state";
import { Tables } from "./tables";

function Choice(props: { label: string; value: string; options: [string, string][]; onChange: (value: string) => void }) {
  return (
    <label>
      {props.label}{" "}
      <select value={props.value} onChange={(event) => props.onChange(event.currentTarget.value)}>
        {props.options.map(([value, text]) => (
          <option key={value} value={value}>
            {text}
          </option>
        ))}
      </select>
    </label>
  );
}

function Check(props: { label: string; checked: boolean; onChange: (value: boolean) => void }) {
  return (
    <label>
      <input type="checkbox" checked={props.checked} onChange={(event) => props.onChange(event.currentTarget.checked)} /> {props.label}
    </label>
  );
}

function Slider(props: { label: string; value: number; min: number; max: number; step?: number; onChange: (value: number) => void }) {
  return (
    <label class="slider">
      {props.label}{" "}
      <input
        type="range"
        min={props.min}
        max={props.max}
        step={props.step ?? (props.max - props.min) / 200}
        value={props.value}
        onInput={(event) => props.onChange(+event.currentTarget.value)}
      />
    </label>
  );
}

function ColourBar() {
  const map = page.objects[state.object.value].maps[state.map.value];
  if (!map) return null;
  if (map.categories) {
    const all = map.histogram.reduce((sum, count) => sum + count, 0) || 1;
    return (
      <ul class="categories" aria-label={map.label}>
        {map.categories.map((one, i) => (
          <li key={i}>
            <span class="swatch" style={{ "--colour": `rgb(${one.colour.join(",")})` }} aria-hidden="true" /> {one.text}{" "}
            <span class="quiet">{numberText(+((100 * map.histogram[i]) / all).toFixed(1))} %</span>
          </li>
        ))}
      </ul>
    );
  }
  const most = Math.max(1, ...map.histogram);
  const middle = (map.from + map.to) / 2;
  const low = (map.minimum < map.from ? "≤ " : "") + numberText(map.from);
  const high = (map.maximum > map.to ? "≥ " : "") + numberText(map.to);
  return (
    <div class="bar" role="img" aria-label={`${map.label}: ${low} – ${high}`}>
      <div class="histogram">
        {map.histogram.map((count, i) => (
          <span key={i} style={{ height: `${(100 * count) / most}%` }} title={numberText(count)} />
        ))}
      </div>
      <div class="colours" style={{ background: gradient(map.colours) }} />
      <div class="ends">
        <span>{low}</span>
        <span>{numberText(middle)}</span>
        <span>{high}</span>
      </div>
      <div class="quiet">{map.label}</div>
    </div>
  );
}

function keepAddress() {
  history.replaceState(null, "", address());
  state.message.value = word("copied");
  void navigator.clipboard?.writeText(location.href).catch(() => {});
}

function Toolbar() {
  const about = page.objects[state.object.value];
  const partner = state.blendPartner.value;
  return (
    <div class="toolbar" role="toolbar" aria-label={word("view")}>
      {page.objects.length > 1 && (
        <>
          <Choice
            label={word("objects")}
            value={String(state.object.value)}
            options={page.objects.map((one, i) => [String(i), one.name])}
            onChange={(value) => state.choose(-1, +value)}
          />
          {!state.sideBySide.value && (
            <Slider
              label={word("step", state.object.value + 1, page.objects.length)}
              value={state.object.value}
              min={0}
              max={page.objects.length - 1}
              step={1}
              onChange={(value) => state.choose(-1, value)}
            />
          )}
          <Check label={word("sideBySide")} checked={state.sideBySide.value} onChange={(value) => (state.sideBySide.value = value)} />
        </>
      )}
      <ColouringChoice />
      <Light />
      {partner >= 0 && (
        <Slider
          label={word("blend", about.name, page.objects[partner].name)}
          value={state.blend.value}
          min={0}
          max={1}
          onChange={(value) => (state.blend.value = value)}
        />
      )}
      {about.parts && (
        <Slider label={word("explode")} value={state.explode.value} min={0} max={2} onChange={(value) => (state.explode.value = value)} />
      )}
      {about.cage && <Check label={word("cage")} checked={state.cage.value} onChange={(value) => (state.cage.value = value)} />}
      <span class="group">
        <button type="button" onClick={() => view?.home()}>
          {word("fit")}
        </button>
        {sixViews.map(([key, azimuth, elevation]) => (
          <button key={key} type="button" onClick={() => view?.look(azimuth, elevation)}>
            {word(key)}
          </button>
        ))}
      </span>
      <Slider label={word("clip")} value={state.clip.value} min={-1} max={1} onChange={(value) => (state.clip.value = value)} />
      <Choice
        label={word("clipAxis")}
        value={String(state.clipAxis.value)}
        options={["x", "y", "z"].map((name, i) => [String(i), name])}
        onChange={(value) => (state.clipAxis.value = +value)}
      />
      <Check
        label={word("measure")}
        checked={state.measuring.value}
        onChange={(value) => {
          state.measuring.value = value;
          state.message.value = value ? word("measureOn") : "";
        }}
      />
      <Check label={word("patterns")} checked={state.patterns.value} onChange={(value) => (state.patterns.value = value)} />
      <button type="button" onClick={() => view && savePicture(view, page.title)}>
        {word("picture")}
      </button>
      <button type="button" onClick={keepAddress}>
        {word("link")}
      </button>
    </div>
  );
}

export function App() {
  void state.turn.value; // another object of a collection: recompute everything
  const about = page.objects[state.object.value];
  const { simplified } = about ?? {};
  const ready = state.ready.value || !view;
  return (
    <>
      <header>
        <h1>{page.title}</h1>
        {state.entry.value >= 0 && (
          <button type="button" onClick={closeEntry}>
            {word("backToIndex")}
          </button>
        )}
        <Choice
          label={word("language")}
          value={state.language.value}
          options={[
            ["en", "English"],
            ["de", "Deutsch"],
            ["it", "Italiano"],
          ]}
          onChange={(value) => state.setLanguage(value as Language)}
        />
        <Choice
          label={word("theme")}
          value={state.theme.value}
          options={(["system", "light", "dark"] as const).map((name) => [name, word(name)])}
          onChange={state.setTheme}
        />
      </header>
      <main key={state.turn.value}>
        {page.collection && <Index />}
        {about && (
          <div class="stage">
            <div class="left">
              {view && <Toolbar />}
              <Picture />
              <p class="quiet status" role="status">
                {about.name}: {numberText(about.vertices)} {word("vertices")}, {numberText(about.faces)} {word("faces")}
                {simplified &&
                  `. ${word("shown", numberText(simplified.vertices), numberText(about.vertices), numberText(simplified.deviation) + (about.unit ? " " + about.unit : ""))}`}
                {state.message.value && ` – ${state.message.value}`}
              </p>
            </div>
            <aside tabIndex={0} aria-label={word("annotations")}>
              {ready && (
                <>
                  <ColourBar />
                  <Legend />
                  <Details />
                </>
              )}
            </aside>
          </div>
        )}
        {ready && about && (
          <>
            <Conformance />
            <Constraints />
            <Slices />
            <Graph />
          </>
        )}
        {(ready || !about) && (
          <>
            <Tables blobs={state.blobs} />
            {page.notes.length > 0 && (
              <section aria-labelledby="notes-title">
                <h2 id="notes-title">{word("notes")}</h2>
                <ul>
                  {page.notes.map((note, i) => (
                    <li key={i}>{note}</li>
                  ))}
                </ul>
              </section>
            )}
            <section aria-labelledby="about-title">
              <details>
                <summary>
                  <h2 id="about-title">{word("about")}</h2>
                </summary>
                <pre tabIndex={0}>{page.provenance}</pre>
              </details>
            </section>
          </>
        )}
      </main>
    </>
  );
}
