// Forms for all operations of the table: generated from the declarations, with inputs offered from the session.
import { useState } from "preact/hooks";
import { files, has, object, objects, operations, run, type Declaration, type OperationInput, type OperationOption } from "./model";
import { wantedForm } from "./remedies";
import { text } from "./words";

/** Kinds of inputs, and the parts of objects that have this kind. */
const partOfKind: Record<string, string[]> = {
  mesh: ["mesh", "deformed"],
  annotations: ["annotations", "deformed annotations"],
  graph: ["graph"],
  cage: ["cage", "deformed cage"],
  coordinates: ["coordinates"],
  recipe: ["recipe"],
  edit: ["edit"],
};

interface Offer {
  key: string;
  label: string;
  value: unknown;
}

/** The files of the session that can be given as an input of a kind. */
function offers(kind: string): Offer[] {
  const found: Offer[] = [];
  const parts = partOfKind[kind] ?? [];
  objects.value.forEach((one, i) => {
    for (const which of parts)
      if (one.parts[which]) found.push({ key: `${i}/${which}`, label: `${one.name}: ${which}`, value: { part: which, object: i } });
  });
  for (const file of files.value) if (file.kind === kind) found.push({ key: file.file, label: file.name, value: { file: file.file } });
  return found;
}

/** Initial selection: the active object. */
function preset(input: OperationInput, list: Offer[]): string {
  const own = objects.value.indexOf(object.value!);
  const mine = list.find((one) => one.key.startsWith(`${own}/`));
  return mine && (input.required || has((partOfKind[input.kind] ?? [])[0])) ? mine.key : "";
}

function Field({ option, value, onChange }: { option: OperationOption; value: unknown; onChange: (value: unknown) => void }) {
  const id = `option-${option.name}`;
  const help = option.help + (option.unit ? ` (${option.unit})` : "");
  const isNumber = option.type === "integer" || option.type === "number";
  return (
    <div class="field">
      <label for={id} title={help}>
        {option.name}
      </label>
      {option.type === "boolean" ? (
        <input
          id={id}
          type="checkbox"
          checked={(value ?? option.default) === true}
          onChange={(event) => onChange(event.currentTarget.checked)}
        />
      ) : option.type === "choice" ? (
        <select id={id} value={String(value ?? option.default ?? "")} onChange={(event) => onChange(event.currentTarget.value)}>
          {option.default === undefined && <option value="" />}
          {option.choices!.map((one) => (
            <option key={one} value={one}>
              {one}
            </option>
          ))}
        </select>
      ) : (
        <>
          <input
            id={id}
            type={isNumber ? "number" : "text"}
            step={option.type === "integer" ? 1 : "any"}
            min={option.minimum}
            max={option.maximum}
            placeholder={option.default === undefined ? "" : String(option.default)}
            value={value === undefined ? "" : String(value)}
            list={option.words ? `${id}-words` : undefined}
            onInput={(event) => onChange(event.currentTarget.value === "" ? undefined : event.currentTarget.value)}
          />
          {option.words && (
            <datalist id={`${id}-words`}>
              {option.words.map((one) => (
                <option key={one} value={one} />
              ))}
            </datalist>
          )}
        </>
      )}
      <small>{help}</small>
    </div>
  );
}

/** Converts a text to the type in the table; lists of texts are separated by semicolons. */
function valueOf(option: OperationOption, raw: unknown): unknown {
  if (typeof raw !== "string") return raw;
  switch (option.type) {
    case "integer":
    case "number":
      return Number(raw);
    case "texts":
      return raw
        .split(";")
        .map((one) => one.trim())
        .filter((one) => one !== "");
    case "integers":
    case "numbers":
      return raw
        .split(/[\s,;]+/)
        .filter((one) => one !== "")
        .map(Number);
    default:
      return raw;
  }
}

function Form({ of }: { of: Declaration }) {
  const [values, setValues] = useState<Record<string, unknown>>({});
  const [given, setGiven] = useState<Record<string, string[]>>({});
  const [wanted, setWanted] = useState<ReadonlySet<string>>(new Set());
  const chosen = (input: OperationInput) => {
    const list = offers(input.kind);
    return given[input.name] ?? (input.repeated ? [] : [preset(input, list)]);
  };
  const submit = async (event: Event) => {
    event.preventDefault();
    const all: Record<string, unknown> = {};
    for (const input of of.inputs) {
      const list = offers(input.kind);
      const found = chosen(input)
        .map((key) => list.find((one) => one.key === key)?.value)
        .filter((one) => one !== undefined);
      if (found.length > 0) all[input.name] = input.repeated ? found : found[0];
    }
    for (const option of of.options) if (values[option.name] !== undefined) all[option.name] = valueOf(option, values[option.name]);
    await run({ operation: of.name, title: of.name, with: all, keep: [...wanted] });
  };
  return (
    <form class="operation" onSubmit={submit}>
      <p class="quiet">{of.help}</p>
      {of.inputs.map((input) => {
        const list = offers(input.kind);
        if (list.length === 0 && !input.required) return null;
        const now = chosen(input);
        return (
          <div class="field" key={input.name}>
            <label for={`input-${input.name}`}>
              {input.name}
              {input.required ? " *" : ""}
            </label>
            <select
              id={`input-${input.name}`}
              multiple={input.repeated}
              required={input.required && input.kind !== "annotations" && input.kind !== "graph"}
              onChange={(event) => setGiven({ ...given, [input.name]: [...event.currentTarget.selectedOptions].map((one) => one.value) })}
            >
              {!input.repeated && <option value="" selected={now[0] === ""} />}
              {list.map((one) => (
                <option key={one.key} value={one.key} selected={now.includes(one.key)}>
                  {one.label}
                </option>
              ))}
            </select>
            <small>{input.help}</small>
          </div>
        );
      })}
      {of.options
        .filter((one) => one.name !== "force-mesh")
        .map((option) => (
          <Field
            key={option.name}
            option={option}
            value={values[option.name]}
            onChange={(value) => setValues({ ...values, [option.name]: value })}
          />
        ))}
      {of.outputs
        .filter((one) => !one.required)
        .map((output) => (
          <div class="field" key={output.name}>
            <label>
              <input
                type="checkbox"
                checked={wanted.has(output.name)}
                onChange={(event) => {
                  const next = new Set(wanted);
                  if (event.currentTarget.checked) next.add(output.name);
                  else next.delete(output.name);
                  setWanted(next);
                }}
              />{" "}
              {output.name}
            </label>
            <small>{output.help}</small>
          </div>
        ))}
      <button type="submit">{text("run", of.name)}</button>
    </form>
  );
}

/** Operations that do not work on the session. */
const elsewhere = /^(run|replay|conformance .*|operations|study make .*)$/;

/** A form for all operations, or for one of them. */
export function Operations({ only }: { only?: string }) {
  const name = only ?? wantedForm.value;
  const of = operations.value.find((one) => one.name === name);
  return (
    <>
      {!only && (
        <label class="field">
          {text("operation")}{" "}
          <select value={name} onChange={(event) => (wantedForm.value = event.currentTarget.value)}>
            {operations.value
              .filter((one) => !elsewhere.test(one.name))
              .map((one) => (
                <option key={one.name} value={one.name}>
                  {one.name}
                </option>
              ))}
          </select>
        </label>
      )}
      {of && <Form key={name} of={of} />}
    </>
  );
}

/** Description of an operation from the table. */
export const helpOf = (name: string) => operations.value.find((one) => one.name === name)?.help ?? "";
