// What a study of technique writes down: report, tables, plots.
#pragma once

#include "study.h"

#include "ostraka/collection/technique_study.h"

namespace ostraka::app {

void add_technique_result(JsonValue& result, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects,
                          JsonAllocator& allocator);
/// {"format": "ostraka-technique", "version", members of `result`, "provenance"}, checked against its schema.
void validate_and_write(const Path& file, const JsonValue& result, const Provenance& provenance);
/// descriptors, classifiers, divisions, answers: .md, .csv, .tex
void write_technique_tables(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects);
/// roundness.svg, eccentricity.svg, outside.svg; with known answers classifiers.svg and roc.svg.
void draw_technique(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects);
/// For the terminal.
std::string technique_summary(const TechniqueStudy& study, const std::vector<TechniqueObject>& objects, std::size_t left_out);

}  // namespace ostraka::app
