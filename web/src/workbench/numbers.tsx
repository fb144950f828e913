// Deformation by numbers: one part is made higher or longer, raised or turned, while others keep their level or their shape. No cage is needed.
import { signal } from "@preact/signals";
import { useState } from "preact/hooks";
import * as page from "../state";
import { has, outcome, part, run } from "./model";
import { text } from "./words";

type Change = "stretch" | "raise" | "rotate";
const axes = ["up", "x", "y", "z"] as const;

/** Words for parts that most likely stay on one level. */
const standing = /leg|foot|feet|bein|fu(ß|ss|ess)|gamb|pied|base/i;

/** The part that was chosen last, also when the result is shown. */
const lastPart = signal<number | undefined>(undefined);

export function ByNumbers() {
  const about = page.page.objects[page.object.value];
  const regions = about?.annotations.filter((one) => one.type === "region") ?? [];
  const chosen = about?.annotations[page.chosen.value]?.id;
  const given = regions.some((one) => one.id === lastPart.value) ? lastPart.value : undefined;
  const [change, setChange] = useState<Change>("stretch");
  const [axis, setAxis] = useState<(typeof axes)[number]>("up");
  const [amount, setAmount] = useState("20");
  const [kept, setKept] = useState<ReadonlyMap<string, boolean>>(new Map());
  const id = given ?? chosen ?? regions[0]?.id;
  const others = regions.filter((one) => one.id !== id && one.faces && one.faces.count < about.faces);
  const keeps = (what: "level" | "shape", one: { id: number; tag: string }) =>
    kept.get(`${what} ${one.id}`) ?? (what === "level" && standing.test(one.tag));
  if (!about || !has("annotations") || regions.length === 0)
    return (
      <section aria-labelledby="numbers-title">
        <h2 id="numbers-title">{text("byNumbers")}</h2>
        <p class="quiet">{text("byNumbersEmpty")}</p>
      </section>
    );
  const unit = { stretch: "%", raise: about.unit, rotate: "°" }[change];
  const submit = (event: Event) => {
    event.preventDefault();
    const value = Number(amount);
    const number = change === "stretch" ? Number((1 + value / 100).toFixed(6)) : value;
    const tag = about.annotations.find((one) => one.id === id)?.tag ?? "";
    const level = others.filter((one) => keeps("level", one)).map((one) => one.id);
    const shapes = others.filter((one) => keeps("shape", one)).map((one) => String(one.id));
    const options: Record<string, unknown> = {
      mesh: part("mesh"),
      annotations: part("annotations"),
      [change]: [`${id}=${number}${axis === "up" ? "" : `,${axis}`}`],
    };
    if (has("graph")) options.graph = part("graph");
    if (level.length > 1) options.level = [level.join(",")];
    if (shapes.length > 0) options.keep = shapes;
    void run({
      operation: "deform",
      title: `${text(change)}: ${tag} ${amount} ${unit}`,
      with: options,
      keep: ["annotations-out"],
      as: "deformed",
    });
  };
  const last = outcome.value;
  return (
    <section aria-labelledby="numbers-title">
      <h2 id="numbers-title">{text("byNumbers")}</h2>
      <form class="numbers" onSubmit={submit}>
        <select aria-label={text("partOf")} value={String(id)} onChange={(event) => (lastPart.value = Number(event.currentTarget.value))}>
          {regions.map((one) => (
            <option key={one.id} value={String(one.id)}>
              {one.tag || `#${one.id}`}
            </option>
          ))}
        </select>
        <select aria-label={text("changeKind")} value={change} onChange={(event) => setChange(event.currentTarget.value as Change)}>
          {(["stretch", "raise", "rotate"] as const).map((one) => (
            <option key={one} value={one}>
              {text(one)}
            </option>
          ))}
        </select>
        <span>
          <input
            type="number"
            step="any"
            aria-label={text("amount")}
            value={amount}
            required
            onInput={(event) => setAmount(event.currentTarget.value)}
          />{" "}
          {unit}
        </span>
        <select aria-label={text("along")} value={axis} onChange={(event) => setAxis(event.currentTarget.value as "up")}>
          {axes.map((one) => (
            <option key={one} value={one}>
              {one === "up" ? text("upward") : text("alongAxis", one)}
            </option>
          ))}
        </select>
        {change === "stretch" && <small class="quiet">{text("fromBase")}</small>}
        {others.length > 0 && (
          <fieldset>
            <legend>{text("othersKeep")}</legend>
            {others.map((one) => (
              <div key={one.id} class="kept">
                <span>{one.tag || `#${one.id}`}</span>
                {(["level", "shape"] as const).map((what) => (
                  <label key={what}>
                    <input
                      type="checkbox"
                      checked={keeps(what, one)}
                      onChange={(event) => setKept(new Map(kept).set(`${what} ${one.id}`, event.currentTarget.checked))}
                    />{" "}
                    {text(what === "level" ? "keepLevel" : "keepShape")}
                  </label>
                ))}
              </div>
            ))}
          </fieldset>
        )}
        <button type="submit" class="remedy">
          {text("doIt")}
        </button>
      </form>
      {has("deformed") && last && (
        <p role="status" class={last.holds ? "verdict holds" : "verdict broken"}>
          {text(last.holds ? "resultGood" : "resultBad")}
        </p>
      )}
    </section>
  );
}
