#include "npy_shape.h"

#include "ostraka/core/error.h"

#include <charconv>
#include <cmath>
#include <cstring>

namespace ostraka {

std::vector<std::uint64_t> npy_shape(const Path& file) {
    const std::string bytes = read_file(file);
    const std::string where = file.string(), remedy = "write it with numpy.save, as float64";
    if (bytes.size() < 12 || bytes.compare(0, 6, "\x93NUMPY") != 0) fail_input(where, "is no NumPy array", remedy);
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
    const bool wide = byte(6) >= 2;
    const std::size_t begin = wide ? 12 : 10;
    const std::size_t length = byte(8) | byte(9) << 8 | (wide ? byte(10) << 16 | byte(11) << 24 : 0);
    if (length > bytes.size() - begin) fail_input(where, "the head of the array is cut off", remedy);
    const std::string head = bytes.substr(begin, length);
    if (head.find("'<f8'") == std::string::npos) fail_input(where, "the array is not of little-endian float64", remedy);
    const std::size_t open = head.find('(', head.find("'shape'")), close = head.find(')', open);
    if (head.find("'shape'") == std::string::npos || close == std::string::npos)
        fail_input(where, "the array has no shape", remedy);
    std::vector<std::uint64_t> shape;
    std::uint64_t count = 1;
    for (std::size_t i = open + 1; i < close;) {
        if (head[i] == ' ' || head[i] == ',') {
            ++i;
            continue;
        }
        std::uint64_t number = 0;
        const auto [end, error] = std::from_chars(head.data() + i, head.data() + close, number);
        if (error != std::errc() || number > bytes.size() || (number > 0 && count > bytes.size() / number))
            fail_input(where, "the shape of the array does not fit the size of the file", remedy);
        count *= number;
        shape.push_back(number);
        i = static_cast<std::size_t>(end - head.data());
    }
    if (count * sizeof(double) != bytes.size() - begin - length)
        fail_input(where, "the shape of the array does not fit the size of the file", remedy);
    for (std::uint64_t i = 0; i < count; ++i) {
        double value = 0;
        std::memcpy(&value, bytes.data() + begin + length + i * sizeof value, sizeof value);
        if (!std::isfinite(value))
            fail_input(where, "number " + std::to_string(i) + " of the array is not finite", "compute it anew");
    }
    return shape;
}

}  // namespace ostraka
