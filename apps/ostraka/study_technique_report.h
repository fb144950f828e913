// What a study of technique writes down: report, tables, plots.
#pragma once

#include "study.h"

#include "ostraka/collection/technique_study.h"

namespace ostraka::app {

void add_technique_result(JsonValue& result, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects,
                          JsonAllocator& allocator);
KnownAnswers known_answers(const std::vector<TechniqueObject>& objects);
/// descriptors, classifiers, divisions, answers: .md, .csv, .tex
void write_technique_tables(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects);
/// Plots roundness, eccentricity and ovality; with known answers classifiers and roc.
void draw_technique(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects);
/// For the terminal.
std::string technique_summary(const TechniqueStudy& study, const std::vector<TechniqueObject>& objects, std::size_t left_out);

}  // namespace ostraka::app
