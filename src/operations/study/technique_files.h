// Tables and plots that a study of technique writes into its folder.
#pragma once

#include "operations/study/common.h"

#include "ostraka/collection/technique_study.h"

namespace ostraka {

/// Text that names the classifier or descriptor whose answers are used.
std::string answering_words(const TechniqueStudy& study);
/// Writes the tables descriptors, classifiers, divisions and answers as .md, .csv and .tex.
void write_technique_tables(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects);
/// Plots roundness, eccentricity and ovality; with known answers also classifiers and ROC curves.
void draw_technique(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects);

}  // namespace ostraka
