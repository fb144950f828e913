// Results of the constraints of a deformation, and conformance of an object to the rules and relationships of its class.
import { choose, chosen, numberText, object, page, withUnit, word } from "./state";

type Answer = "holds" | "broken" | "unknown";
const answerOf = (holds: boolean | undefined): Answer => (holds === undefined ? "unknown" : holds ? "holds" : "broken");

function Verdict({ answer }: { answer: Answer }) {
  return (
    <span class={`verdict ${answer}`}>
      <span aria-hidden="true">{{ holds: "✓", broken: "✗", unknown: "?" }[answer]}</span> {word(answer)}
    </span>
  );
}

function Members({ members }: { members: number[] }) {
  const { annotations } = page.objects[object.value];
  return (
    <>
      {members.map((m, k) => (
        <span key={k}>
          {k > 0 && ", "}
          <button type="button" class="link" onClick={() => choose(m)}>
            {annotations[m]?.tag || `#${annotations[m]?.id ?? m}`}
          </button>
        </span>
      ))}
    </>
  );
}

/** Violations are listed first; satisfied entries are collapsed. */
export function Conformance() {
  const { conformance = [] } = page.objects[object.value];
  if (conformance.length === 0) return null;
  const of = (answer: Answer) => conformance.filter((one) => answerOf(one.holds) === answer);
  const list = (answer: Answer) => (
    <ul class="constraints">
      {of(answer).map((one, i) => (
        <li key={i} class={one.members.includes(chosen.value) ? "chosen" : ""} data-verdict={answer}>
          <Verdict answer={answer} /> {word(one.kind)} <strong>{one.name}</strong>
          {one.members.length > 0 && ": "}
          <Members members={one.members} />
          {one.text && <div>{one.text}</div>}
        </li>
      ))}
    </ul>
  );
  return (
    <section aria-labelledby="conformance-title">
      <h2 id="conformance-title">{word("conformance")}</h2>
      <p>{word("conformanceCounts", of("holds").length, of("broken").length, of("unknown").length)}</p>
      {list("broken")}
      {list("unknown")}
      {of("holds").length > 0 && (
        <details>
          <summary>{word("conformanceHolds", of("holds").length)}</summary>
          {list("holds")}
        </details>
      )}
    </section>
  );
}

export function Constraints() {
  const { constraints = [], conflicts = [] } = page.objects[object.value];
  if (constraints.length === 0 && conflicts.length === 0) return null;
  return (
    <section aria-labelledby="constraints-title">
      <h2 id="constraints-title">{word("constraints")}</h2>
      {conflicts.length > 0 && (
        <ul class="conflicts">
          {conflicts.map((text, i) => (
            <li key={i}>
              <strong>{word("conflict")}</strong>: {text}
            </li>
          ))}
        </ul>
      )}
      <ul class="constraints">
        {constraints.map((one, i) => {
          const verdict = answerOf(one.holds);
          return (
            <li key={i} class={one.members.includes(chosen.value) ? "chosen" : ""} data-verdict={verdict}>
              <Verdict answer={verdict} /> <strong>{one.type}</strong>: <Members members={one.members} />{" "}
              <span class="quiet">
                {word("before")}: {one.before}, {word("after")}: {one.verdict};{" "}
                {one.hard ? word("hard") : `${word("weight")} ${numberText(one.weight)}`}
              </span>
              {one.text && <div>{one.text}</div>}
              {one.deviations.length > 0 && (
                <dl>
                  {one.deviations.map((d, k) => (
                    <div key={k}>
                      <dt>{d.quantity}</dt>
                      <dd>
                        {d.value === null ? "–" : withUnit(d.value, d.unit)}
                        {d.tolerance !== null && ` (${word("atMost", withUnit(d.tolerance, d.unit))})`}
                      </dd>
                    </div>
                  ))}
                  {one.residual && (
                    <div>
                      <dt>{word("residual")}</dt>
                      <dd>{word("meanLargest", numberText(one.residual.mean), numberText(one.residual.largest))}</dd>
                    </div>
                  )}
                </dl>
              )}
            </li>
          );
        })}
      </ul>
    </section>
  );
}
