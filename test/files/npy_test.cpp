#include "ostraka/files/npy.h"

#include "mutate.h"
#include "ostraka/core/error.h"
#include "scratch.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace ostraka {
namespace {

std::string npy(const std::string& type, const std::string& shape, const std::string& data, const std::string& fortran = "False",
                int version = 1) {
    std::string head = "{'descr': '" + type + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
    head.resize(117, ' ');
    head += '\n';
    std::string start = "\x93NUMPY";
    start += static_cast<char>(version);
    start += '\0';
    start += static_cast<char>(head.size());
    start += std::string(version == 1 ? 1 : 3, '\0');
    return start + head + data;
}
template <class Number>
std::string raw(std::initializer_list<Number> numbers) {
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    std::memcpy(bytes.data(), numbers.begin(), bytes.size());
    return bytes;
}
std::string error_of(const std::string& bytes) {
    const test::Scratch folder;
    try {
        (void)read_npy(folder.file("a.npy", bytes));
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_FALSE(error.remedy().empty());
        return error.problem();
    }
    return "accepted";
}

TEST(Npy, RoundTripIsExact) {
    const test::Scratch folder;
    const Path file = folder / "a.npy";
    const std::vector<double> values{1.5, -0.0, 1e-310, std::numeric_limits<double>::infinity(), 1e308, 3};
    for (const std::vector<std::size_t>& shape : {std::vector<std::size_t>{6}, {2, 3}, {6, 1}, {1, 6}}) {
        const std::string checksum = write_npy(file, values, shape);
        EXPECT_EQ(checksum, sha256_of_file(file));
        const auto array = read_npy(file);
        EXPECT_EQ(array.shape, shape);
        ASSERT_EQ(array.values.size(), values.size());
        EXPECT_EQ(std::memcmp(array.values.data(), values.data(), 48), 0);
        EXPECT_EQ((read_file(file).size() - 48) % 64, 0U) << "NumPy aligns the data";
    }
    const std::vector<std::int64_t> integers{std::numeric_limits<std::int64_t>::min(), -1, 0,
                                             std::numeric_limits<std::int64_t>::max()};
    write_npy(file, integers, {2, 2});
    EXPECT_EQ(read_npy_integers(file).values, integers);
    write_npy(file, std::vector<double>{}, {0, 4});
    EXPECT_EQ(read_npy(file).shape, (std::vector<std::size_t>{0, 4}));
    EXPECT_THROW((void)write_npy(file, values, {7}), std::logic_error);
    EXPECT_THROW((void)write_npy(file, values, {1, 2, 3}), std::logic_error);
    EXPECT_EQ(test::count_files(folder.path()), 1U);
}

TEST(Npy, ColumnsFirstAndOtherNumbers) {
    const test::Scratch folder;
    const Path file = folder.file("a.npy", npy("<f8", "(2, 3)", raw<double>({1, 4, 2, 5, 3, 6}), "True"));
    EXPECT_EQ(read_npy(file).values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
    write_file(file, npy("<i4", "(2, 2)", raw<std::int32_t>({1, 3, -2, 4}), "True", 2));
    EXPECT_EQ(read_npy(file).values, (std::vector<double>{1, -2, 3, 4}));
    EXPECT_EQ(read_npy_integers(file).values, (std::vector<std::int64_t>{1, -2, 3, 4}));
    write_file(file, npy("|b1", "(3,)", std::string("\1\0\1", 3), "False", 3));
    EXPECT_EQ(read_npy(file).values, (std::vector<double>{1, 0, 1}));
    write_file(file, npy("<u8", "(1,)", raw<std::uint64_t>({std::uint64_t{1} << 63})));
    EXPECT_THROW((void)read_npy_integers(file), Error);
    write_file(file, npy("<f8", "(1,)", raw<double>({1})));
    EXPECT_THROW((void)read_npy_integers(file), Error);
}

TEST(Npy, FalseHeadersAreRefused) {
    const std::string three = raw<double>({1, 2, 3});
    EXPECT_NE(error_of(npy("<f8", "(4,)", three)).find("does not match"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(1000000000000, 1000000000000)", three)).find("does not match"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(4294967296, 4294967296)", "")).find("does not match"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(2305843009213693952, 8)", "")).find("does not match"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(0, 3)", three)).find("does not match"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(9223372036854775807, 0)", "")).find("does not match"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(99999999999999999999,)", "")).find("does not match"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "()", raw<double>({1}))).find("0 dimensions"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(1, 1, 3)", three)).find("3 dimensions"), std::string::npos);
    EXPECT_NE(error_of(npy(">f8", "(3,)", three)).find("'>f8'"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(-3,)", three)).find("cannot be read"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(3,)", three, "Maybe")).find("cannot be read"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(3,", three)).find("cannot be read"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(3,)", three, "False", 9)).find("version"), std::string::npos);
    EXPECT_NE(error_of(npy("<f8", "(3,)", three).substr(0, 60)).find("ends within"), std::string::npos);
    EXPECT_NE(error_of("").find("not a NumPy"), std::string::npos);
    EXPECT_EQ(error_of(npy("<f8", "(3,)", three)), "accepted");
}

TEST(Npy, DamagedFilesGiveNumbersOrAnError) {
    const test::Scratch folder;
    const std::string good = npy("<f8", "(2, 3)", raw<double>({1, 2, 3, 4, 5, 6}));
    std::size_t refused = 0;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        const std::string bytes = test::mutate(good, seed);
        try {
            const NpyView view = view_npy(bytes, "a.npy");
            std::vector<double> values(view.count());
            view.copy_to(values.data());
            EXPECT_LE(values.size(), bytes.size());
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000U);
}

}  // namespace
}  // namespace ostraka
