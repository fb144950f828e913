// A folder of its own for a test, removed at the end.
#pragma once

#include "ostraka/core/file.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace ostraka::test {

class Folder {
public:
    Folder() {
        std::string pattern = ::testing::TempDir() + "/render.XXXXXX";
        path_ = ::mkdtemp(pattern.data()) == nullptr ? Path(::testing::TempDir()) : Path(pattern);
    }
    ~Folder() {
        std::error_code code;
        if (path_ != Path(::testing::TempDir())) std::filesystem::remove_all(path_, code);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    Path operator/(const std::string& name) const { return path_ / name; }

private:
    Path path_;
};

}  // namespace ostraka::test
