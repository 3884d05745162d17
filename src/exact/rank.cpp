#include <isostat/exact/rank.hpp>

#include <cmath>
#include <map>
#include <vector>

namespace isostat::exact {

namespace {
using u128 = unsigned __int128;
std::uint64_t fold(u128 x) {
    std::uint64_t r = static_cast<std::uint64_t>(x & mersenne61) + static_cast<std::uint64_t>(x >> 61);
    r = (r & mersenne61) + (r >> 61);
    return r >= mersenne61 ? r - mersenne61 : r;
}
std::uint64_t power(std::uint64_t a, std::uint64_t e) {
    std::uint64_t r = 1;
    for (; e != 0; e >>= 1) {
        if (e & 1) r = multiply(r, a);
        a = multiply(a, a);
    }
    return r;
}
} // namespace

std::uint64_t multiply(std::uint64_t a, std::uint64_t b) { return fold(static_cast<u128>(a) * b); }
std::uint64_t subtract(std::uint64_t a, std::uint64_t b) { return a >= b ? a - b : a + mersenne61 - b; }

std::uint64_t residue(double value) {
    if (value == 0) return 0;
    int e = 0;
    const double m = std::frexp(std::abs(value), &e);
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(m, 53));
    int shift = (e - 53) % 61;
    if (shift < 0) shift += 61;
    const std::uint64_t r = fold(static_cast<u128>(mantissa) << shift);
    return value < 0 && r != 0 ? mersenne61 - r : r;
}

int rank(const sparse::Matrix<std::uint64_t>& a, const sparse::Ordering& ordering) {
    // Plain left-looking elimination; dense scratch column.
    const int n = a.rows;
    std::vector<int> rowpos(static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k) rowpos[static_cast<std::size_t>(ordering.row_order()[static_cast<std::size_t>(k)])] = k;
    std::vector<std::vector<std::pair<int, std::uint64_t>>> lower(static_cast<std::size_t>(n));
    std::vector<int> pivot_of_row(static_cast<std::size_t>(n), -1);
    std::vector<std::uint64_t> x(static_cast<std::size_t>(n), 0);
    int rank = 0;
    for (int k = 0; k < n; ++k) {
        const auto col = static_cast<std::size_t>(ordering.column_order()[static_cast<std::size_t>(k)]);
        std::map<int, int> todo;
        std::vector<int> touched;
        std::vector<unsigned char> dummy;
        const auto touch = [&](int r) {
            touched.push_back(r);
            if (pivot_of_row[static_cast<std::size_t>(r)] >= 0) todo.emplace(pivot_of_row[static_cast<std::size_t>(r)], r);
        };
        for (int e = a.start[col]; e < a.start[col + 1]; ++e) {
            const int r = a.row[static_cast<std::size_t>(e)];
            x[static_cast<std::size_t>(r)] = a.value[static_cast<std::size_t>(e)];
            touch(r);
        }
        while (!todo.empty()) {
            const auto [j, r] = *todo.begin();
            todo.erase(todo.begin());
            const std::uint64_t f = x[static_cast<std::size_t>(r)];
            if (f == 0) continue;
            for (const auto& [i, l] : lower[static_cast<std::size_t>(j)]) {
                auto& t = x[static_cast<std::size_t>(i)];
                if (t == 0) touch(i);
                t = subtract(t, multiply(l, f));
            }
        }
        const int preferred = ordering.row_order()[static_cast<std::size_t>(k)];
        int pivot = -1;
        if (pivot_of_row[static_cast<std::size_t>(preferred)] < 0 && x[static_cast<std::size_t>(preferred)] != 0) pivot = preferred;
        for (const int r : touched)
            if (pivot < 0 && pivot_of_row[static_cast<std::size_t>(r)] < 0 && x[static_cast<std::size_t>(r)] != 0) pivot = r;
        if (pivot >= 0) {
            pivot_of_row[static_cast<std::size_t>(pivot)] = rank;
            const std::uint64_t inverse = power(x[static_cast<std::size_t>(pivot)], mersenne61 - 2);
            for (const int r : touched) {
                auto& t = x[static_cast<std::size_t>(r)];
                if (t != 0 && pivot_of_row[static_cast<std::size_t>(r)] < 0) {
                    lower[static_cast<std::size_t>(rank)].emplace_back(r, multiply(t, inverse));
                    t = 0;
                }
            }
            ++rank;
        }
        for (const int r : touched) x[static_cast<std::size_t>(r)] = 0;
    }
    return rank;
}

} // namespace isostat::exact
