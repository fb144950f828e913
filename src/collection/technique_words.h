// Answers of a technique study in words.
#pragma once

#include "ostraka/collection/technique_study.h"

namespace ostraka {

/// Sets `words` of every answer.
void explain_answers(TechniqueStudy& study, const std::vector<TechniqueObject>& objects);

}  // namespace ostraka
