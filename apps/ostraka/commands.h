// The commands of the tool: one registration function a file. A header of their own, so that a new command compiles two files
// only.
#pragma once

#include "command.h"

namespace ostraka::app {

void add_mesh_info(CLI::App& mesh, Session& session);                  // mesh_info.cpp
void add_mesh_convert(CLI::App& mesh, Session& session);               // mesh_convert.cpp
void add_mesh_repair(CLI::App& mesh, Session& session);                // mesh_repair.cpp
void add_mesh_resize(CLI::App& mesh, Session& session);                // mesh_resize.cpp: simplify, refine, remesh
void add_mesh_break(CLI::App& mesh, Session& session);                 // mesh_break.cpp
void add_mesh_make(CLI::App& mesh, Session& session);                  // mesh_make.cpp
void add_annotation(CLI::App& annotation, Session& session);           // annotation.cpp: apply, list, check
void add_annotation_select(CLI::App& annotation, Session& session);    // annotation_select.cpp
void add_annotation_creases(CLI::App& annotation, Session& session);   // annotation_creases.cpp
void add_annotation_facets(CLI::App& annotation, Session& session);    // annotation_facets.cpp
void add_annotation_segment(CLI::App& annotation, Session& session);   // annotation_segment.cpp
void add_annotation_transfer(CLI::App& annotation, Session& session);  // annotation_transfer.cpp
void add_annotation_survival(CLI::App& annotation, Session& session);  // annotation_survival.cpp
void add_axis(CLI::App& tool, Session& session);                       // axis.cpp
void add_slice(CLI::App& tool, Session& session);                      // slice.cpp
void add_relation(CLI::App& relation, Session& session);               // relation.cpp
void add_annotation_exchange(CLI::App& annotation, Session& session);  // annotation_exchange.cpp: export, import
void add_annotation_edit(CLI::App& annotation, Session& session);      // annotation_edit.cpp
void add_annotation_merge(CLI::App& annotation, Session& session);     // annotation_merge.cpp: diff, merge
void add_measure(CLI::App& measure, Session& session);                 // measure.cpp: take, describe, refresh
void add_measure_map(CLI::App& measure, Session& session);             // measure_map.cpp
void add_measure_clay(CLI::App& measure, Session& session);            // measure_clay.cpp
void add_annotation_infer(CLI::App& annotation, Session& session);     // annotation_infer.cpp
void add_template(CLI::App& bundle, Session& session);                 // template.cpp
void add_template_learn(CLI::App& bundle, Session& session);           // template_learn.cpp: learn, classify
void add_template_sample(CLI::App& bundle, Session& session);          // template_sample.cpp: sample, propagate
void add_template_turn(CLI::App& bundle, Session& session);            // template_turn.cpp
void add_vocabulary(CLI::App& vocabulary, Session& session);           // vocabulary.cpp
void add_cage(CLI::App& cage, Session& session);                       // cage.cpp: weights, influence
void add_cage_make(CLI::App& cage, Session& session);                  // cage_make.cpp: make, check, edit
void add_deform(CLI::App& tool, Session& session);                     // deform.cpp
void add_fit(CLI::App& tool, Session& session);                        // fit.cpp
void add_pair(CLI::App& tool, Session& session);                       // pair.cpp
void add_render(CLI::App& tool, Session& session);                     // render.cpp
void add_study_make_proportions(CLI::App& made, Session& session);     // study_make_proportions.cpp
void add_study_landmarks(CLI::App& study, Session& session);           // study_landmarks.cpp
void add_study_proportions(CLI::App& study, Session& session);         // study_proportions.cpp
void add_study_moulds(CLI::App& study, Session& session);              // study_moulds.cpp
void add_study_make_moulds(CLI::App& made, Session& session);          // study_make_moulds.cpp
void add_study_make_technique(CLI::App& made, Session& session);       // study_make_technique.cpp
void add_study_technique(CLI::App& study, Session& session);           // study_technique.cpp
void add_study_segments(CLI::App& study, Session& session);            // study_segments.cpp

}  // namespace ostraka::app
