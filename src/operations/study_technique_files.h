// What a study of technique writes into its folder: tables and plots.
#pragma once

#include "study.h"

#include "ostraka/collection/technique_study.h"

namespace ostraka {

/// Words for the classifier or descriptor that answers.
std::string answering_words(const TechniqueStudy& study);
/// descriptors, classifiers, divisions, answers: .md, .csv, .tex
void write_technique_tables(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects);
/// Plots roundness, eccentricity and ovality; with known answers classifiers and roc.
void draw_technique(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects);

}  // namespace ostraka
