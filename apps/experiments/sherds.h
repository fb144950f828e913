// Shared by the experiments on sherds of vessels.
#pragma once

#include "harness.h"
#include "scenes.h"
#include "shatter.h"

#include "ostraka/fracture/fragment.h"

namespace ostraka::experiments {

struct SherdOptions {
    std::string output = "experiments-output/breaks";
    std::string data = "../shared/data";
    int motions = 3, pots = 4, first = 0;
    bool write = false;
    void list_options(OptionList& list) {
        list("output", output, "folder for tables and meshes").positional();
        list("data", data, "folder with fragments-bottle-pair and fragments-vessel-sherds");
        list("motions", motions, "number of random motions of all sherds", Range{1, 1000});
        list("pots", pots, "number of synthetic vessels of each kind", Range{1, 1000});
        list("first", first, "number of vessels to skip", Range{0, 100000});
        list("write", write, "write the sherds too");
    }
};

/// The five scanned sherds of a vessel with their numbers as names; if the files are missing, none, with a message.
std::vector<Fragment> scanned_sherds(const std::string& data);
std::vector<const Fragment*> pointers_to(const std::vector<Fragment>& fragments);

}  // namespace ostraka::experiments
