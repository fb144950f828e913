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
    void describe(OptionList& visit) {
        visit("output", output, "folder for tables and meshes").positional();
        visit("data", data, "folder with fragments-bottle-pair and fragments-vessel-sherds");
        visit("motions", motions, "number of random motions of all sherds", Range{1, 1000});
        visit("pots", pots, "number of synthetic vessels of each kind", Range{1, 1000});
        visit("first", first, "number of vessels to skip", Range{0, 100000});
        visit("write", write, "write the sherds too");
    }
};

/// The five scanned sherds of a vessel with their numbers as names; if the files are missing, none, with a message.
std::vector<Fragment> scanned_sherds(const std::string& data);
std::vector<const Fragment*> pointers_to(const std::vector<Fragment>& fragments);

}  // namespace ostraka::experiments
