// Details of the selected annotation.
import { swatch } from "./legend";
import { choose, chosen, numberText, object, page, withUnit, word } from "./state";

export function Details() {
  const about = page.objects[object.value];
  const one = about.annotations[chosen.value];
  return (
    <section aria-labelledby="details-title" aria-live="polite">
      <h2 id="details-title">{word("details")}</h2>
      {!one ? (
        <p class="quiet">{word("nothing")}</p>
      ) : (
        <>
          <h3>
            {swatch(one.colour, one.type)} {one.tag || `#${one.id}`}
          </h3>
          <p class="quiet">
            {word(one.type)} {one.id}
            {one.faces && `, ${word("triangles", numberText(one.faces.count))}`}
            {one.parent >= 0 && (
              <>
                {", "}
                {word("partOf")}{" "}
                <button type="button" class="link" onClick={() => choose(one.parent)}>
                  {about.annotations[one.parent].tag}
                </button>
              </>
            )}
          </p>
          {one.note && <p>{one.note}</p>}
          {one.measures.length > 0 && (
            <>
              <h4>{word("measures")}</h4>
              <dl>
                {one.measures.map((m) => (
                  <div key={m.name}>
                    <dt>{m.name}</dt>
                    <dd>
                      {m.value === null ? "–" : withUnit(m.value, m.unit)}
                      {m.uncertainty !== undefined && ` ± ${numberText(m.uncertainty)}`}
                      {m.stale && ` (${word("stale")})`}
                    </dd>
                  </div>
                ))}
              </dl>
            </>
          )}
          {one.attributes.length > 0 && (
            <>
              <h4>{word("attributes")}</h4>
              <dl>
                {one.attributes.map((a) => (
                  <div key={a.name}>
                    <dt>{a.name}</dt>
                    <dd>{a.text}</dd>
                  </div>
                ))}
              </dl>
            </>
          )}
          <Relations of={chosen.value} />
        </>
      )}
    </section>
  );
}

function Relations({ of }: { of: number }) {
  const { relations, annotations } = page.objects[object.value];
  const list = relations.filter((one) => one.members.includes(of));
  if (list.length === 0) return null;
  return (
    <>
      <h4>{word("relations")}</h4>
      <ul>
        {list.map((one, i) => (
          <li key={i}>
            {one.type}:{" "}
            {one.members
              .filter((m) => m !== of)
              .map((m, k) => (
                <>
                  {k > 0 && ", "}
                  <button type="button" class="link" onClick={() => choose(m)}>
                    {annotations[m].tag || `#${annotations[m].id}`}
                  </button>
                </>
              ))}
            {one.constraint && ` (${word("constraint")})`}
            {one.holds !== undefined && ` – ${word(one.holds ? "holds" : "broken")}`}
            {one.text && <span class="quiet"> {one.text}</span>}
          </li>
        ))}
      </ul>
    </>
  );
}
