// What is asked once about an object that was just opened: the unit of its coordinates, and which way is up.
import { signal } from "@preact/signals";
import { drawn } from "../picture";
import * as page from "../state";
import { units } from "./measuring";
import { object, shown } from "./model";
import { axes, guessUp, type Up } from "./stand";
import { choose, setUnit, setUp } from "./tools";
import { text } from "./words";

/** Questions that were answered by "not now" or by leaving the object as it is, by object. */
const dismissed = signal<ReadonlySet<string>>(new Set());
const dismiss = (key: string) => (dismissed.value = new Set(dismissed.value).add(key));

/** The unit in which the longest side of an object of a museum is most likely between 2 cm and 2 m. */
export function likelyUnit(longest: number): (typeof units)[number] {
  if (longest >= 20) return "mm";
  return longest > 2.5 ? "cm" : "m";
}

const inCentimetres = { mm: 0.1, cm: 1, m: 100 };

const guesses = new WeakMap<object, { up: Up; prescribed: boolean }>();

export function FirstQuestions() {
  const about = page.page.objects[page.object.value];
  const of = drawn[page.object.value];
  const one = object.value;
  if (!about || !of || !one || shown.value[page.object.value]?.deformed) return null;
  const asksUnit = !about.unit && !dismissed.value.has(`unit ${one.name}`);
  const isAsFile = about.up[2] > 0.999;
  if (!guesses.has(of.shape)) guesses.set(of.shape, guessUp(of, one.parts.mesh ?? ""));
  const guess = guesses.get(of.shape)!;
  const asksUp = isAsFile && guess.up !== "z" && !dismissed.value.has(`up ${one.name}`);
  const longest = Math.max(...about.size);
  const likely = likelyUnit(longest);
  if (!asksUnit && !asksUp) return null;
  return (
    <div class="first">
      {asksUp && (
        <section aria-label={text("base")}>
          <p>{text(guess.prescribed ? "upPrescribed" : "upGuess", guess.up)}</p>
          <div class="buttons">
            <button type="button" class="remedy" onClick={() => void setUp(axes[guess.up])}>
              {text("standIt")}
            </button>
            <select
              aria-label={text("otherUp")}
              value=""
              onChange={(event) => {
                if (event.currentTarget.value) void setUp(axes[event.currentTarget.value as Up]);
              }}
            >
              <option value="">{text("otherUp")}</option>
              {(Object.keys(axes) as Up[]).map((up) => (
                <option key={up} value={up}>
                  {up}
                </option>
              ))}
            </select>
            <button type="button" onClick={() => choose("base")}>
              {text("byBase")}
            </button>
            <button type="button" onClick={() => dismiss(`up ${one.name}`)}>
              {text("asItIs")}
            </button>
          </div>
        </section>
      )}
      {asksUnit && (
        <section aria-label={text("unit")}>
          <p>
            {text("unitAsk", page.numberText(Number(longest.toPrecision(3))), likely)}{" "}
            <span class="quiet">
              {text("unitWould", `${page.numberText(Number((longest * inCentimetres[likely]).toPrecision(2)))} cm`)}
            </span>
          </p>
          <div class="buttons">
            {units.map((unit) => (
              <button key={unit} type="button" class={unit === likely ? "remedy" : ""} onClick={() => void setUnit(unit)}>
                {unit}
              </button>
            ))}
            <button type="button" onClick={() => dismiss(`unit ${one.name}`)}>
              {text("notNow")}
            </button>
          </div>
        </section>
      )}
    </div>
  );
}
