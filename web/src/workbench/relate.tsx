// The form that adds a relationship, made from the declaration of its type.
import { useState } from "preact/hooks";
import * as page from "../state";
import { helpOf } from "./forms";
import { has, operations, outcome, part, problem, run } from "./model";
import { isGrouped, parametersOf, typeGroups, type Parameter } from "./relation-types";
import { text, type Key } from "./words";

/** How strongly a constraint is met: its weight, or exactly. */
const strengths = { soft: { weight: 1 }, strong: { weight: 1000 }, exact: { weight: 1000, hard: true } } as const;
type Strength = keyof typeof strengths;

const nameOf = (type: string) => (isGrouped(type) ? text(`rel_${type}` as Key) : type);

/** A parameter as it is written into the constraint; undefined: it is left out. */
function valueOf(parameter: Parameter, given: string): unknown {
  if (given.trim() === "") return undefined;
  if (parameter.kind === "number") return Number(given);
  if (parameter.kind === "vector")
    return given
      .split(/[\s,;]+/)
      .filter((one) => one !== "")
      .map(Number);
  if (parameter.kind === "follow") return given === "true" ? true : Number(given);
  return given;
}

function ParameterField(props: { parameter: Parameter; members: string[]; value: string; onChange: (value: string) => void }) {
  const { parameter, members } = props;
  const { annotations } = page.page.objects[page.object.value];
  const mine = annotations.filter((one) => members.includes(String(one.id)));
  const choices: [string, string][] =
    parameter.kind === "word"
      ? parameter.words!.map((one) => [one, one])
      : parameter.kind === "follow"
        ? [["true", text("followEdited")], ...mine.map((one): [string, string] => [String(one.id), one.tag])]
        : parameter.kind === "measure"
          ? [...new Set(mine.flatMap((one) => one.measures.map((m) => m.name)))].map((one) => [one, one])
          : [];
  const id = `parameter-${parameter.name}`;
  return (
    <label class="field" for={id}>
      {text(`par_${parameter.name}` as Key)}{" "}
      {parameter.kind === "number" || parameter.kind === "vector" ? (
        <input
          id={id}
          type={parameter.kind === "number" ? "number" : "text"}
          step="any"
          min={parameter.minimum}
          max={parameter.maximum}
          list={undefined}
          placeholder={parameter.kind === "vector" ? "0, 0, 1" : ""}
          value={props.value}
          onInput={(event) => props.onChange(event.currentTarget.value)}
        />
      ) : (
        <select id={id} value={props.value} onChange={(event) => props.onChange(event.currentTarget.value)}>
          <option value="">{text("asUsual")}</option>
          {choices.map(([value, label]) => (
            <option key={value} value={value}>
              {label}
            </option>
          ))}
        </select>
      )}
    </label>
  );
}

export function AddRelation() {
  const about = page.page.objects[page.object.value];
  const chosen = about?.annotations[page.chosen.value]?.id;
  const [type, setType] = useState("same level");
  const [picked, setPicked] = useState<string[] | undefined>(undefined);
  const [constrains, setConstrains] = useState(true);
  const [strength, setStrength] = useState<Strength>("soft");
  const [values, setValues] = useState<Record<string, string>>({});
  const [attribute, setAttribute] = useState("");
  const [json, setJson] = useState("");
  if (!about) return null;
  const members = picked ?? (chosen === undefined ? [] : [String(chosen)]);
  const types = operations.value.find((one) => one.name === "relation add")?.options.find((one) => one.name === "type")?.words ?? [];
  const parameters = parametersOf[type] ?? [];
  const submit = async (event: Event) => {
    event.preventDefault();
    const given: Record<string, unknown> = {
      mesh: part("mesh"),
      annotations: part("annotations"),
      type,
      annotation: members,
      constraint: constrains,
    };
    if (has("graph")) given.graph = part("graph");
    if (type === "equal attributes" && attribute) given.attribute = attribute;
    if (constrains) {
      const { weight, ...more } = strengths[strength];
      given.weight = weight;
      const all: Record<string, unknown> = { ...more };
      for (const one of parameters) {
        const value = valueOf(one, values[one.name] ?? "");
        if (value !== undefined) all[one.name] = value;
      }
      if (!isGrouped(type) && json.trim()) given.parameters = json;
      else if (Object.keys(all).length > 0) given.parameters = JSON.stringify(all);
    }
    if (!(await run({ operation: "relation add", title: `${text("addRelation")}: ${nameOf(type)}`, with: given, keep: ["output"] })))
      return;
    // What a deformation would refuse is said now, not at the next drag.
    const refused = outcome.value?.notes.find((one) => one.includes("will refuse this constraint"));
    if (refused)
      problem.value = { problem: refused.replace(/^'deform' will refuse this constraint: /, `${text("refused")}: `), remedy: "" };
    setPicked(undefined);
  };
  return (
    <section aria-labelledby="relation-add">
      <h2 id="relation-add">{text("addRelation")}</h2>
      <form class="operation" onSubmit={(event) => void submit(event)}>
        <label class="field">
          {text("type")}{" "}
          <select
            value={type}
            onChange={(event) => {
              setType(event.currentTarget.value);
              setValues({});
            }}
          >
            {Object.entries(typeGroups).map(([group, list]) => (
              <optgroup key={group} label={text(group as Key)}>
                {list
                  .filter((one) => types.includes(one))
                  .map((one) => (
                    <option key={one} value={one}>
                      {nameOf(one)}
                    </option>
                  ))}
              </optgroup>
            ))}
            <optgroup label={text("groupSolver")}>
              {types
                .filter((one) => !isGrouped(one))
                .map((one) => (
                  <option key={one} value={one}>
                    {one}
                  </option>
                ))}
            </optgroup>
          </select>
        </label>
        <fieldset class="members">
          <legend>{text("members")}</legend>
          {about.annotations.map((one) => {
            const id = String(one.id);
            return (
              <label key={one.id}>
                <input
                  type="checkbox"
                  checked={members.includes(id)}
                  onChange={(event) => setPicked(event.currentTarget.checked ? [...members, id] : members.filter((other) => other !== id))}
                />{" "}
                {one.tag || `#${one.id}`}
              </label>
            );
          })}
        </fieldset>
        {type === "equal attributes" && (
          <label class="field">
            {text("attributeName")} <input value={attribute} required onInput={(event) => setAttribute(event.currentTarget.value)} />
          </label>
        )}
        <label class="field">
          <input type="checkbox" checked={constrains} onChange={(event) => setConstrains(event.currentTarget.checked)} />{" "}
          {text("constrains")}
        </label>
        {constrains && (
          <>
            <label class="field">
              {text("strength")}{" "}
              <select value={strength} onChange={(event) => setStrength(event.currentTarget.value as Strength)}>
                {(Object.keys(strengths) as Strength[]).map((one) => (
                  <option key={one} value={one}>
                    {text(one)}
                  </option>
                ))}
              </select>
            </label>
            {parameters.map((one) => (
              <ParameterField
                key={`${type} ${one.name}`}
                parameter={one}
                members={members}
                value={values[one.name] ?? ""}
                onChange={(value) => setValues({ ...values, [one.name]: value })}
              />
            ))}
            {!isGrouped(type) && (
              <label class="field">
                {text("parameters")} <input value={json} placeholder="{}" onInput={(event) => setJson(event.currentTarget.value)} />
              </label>
            )}
          </>
        )}
        <button type="submit" disabled={members.length === 0} title={helpOf("relation add")}>
          {text("addRelation")}
        </button>
      </form>
    </section>
  );
}
