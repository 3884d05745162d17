#include "core/dot.hpp"
#include "motion/chord.hpp"

#include <algorithm>

namespace isostat {

void Acceleration::improve(std::vector<double>& y) {
    if (count_ > 0) {
        Change& latest = changes_[(count_ - 1) % depth];
        latest.x = x_;
        latest.y.resize(y.size());
        std::transform(y.begin(), y.end(), y_.begin(), latest.y.begin(),
                       [](double now, double before) { return now - before; });
        for (std::size_t k = 0; k < std::min(count_, depth); ++k) {
            const double product = dot(latest.y, changes_[k].y);
            products_[(count_ - 1) % depth][k] = products_[k][(count_ - 1) % depth] = product;
        }
    }
    y_ = y;
    // Least squares |y - sum_j c_j dy_j|, youngest first, by elimination; what repeats the younger ones is left out.
    const std::size_t known = std::min(count_, depth);
    std::array<std::array<double, depth>, depth> gram{};
    std::array<double, depth> c{};
    const auto place = [&](std::size_t age) { return (count_ - 1 - age) % depth; };
    const auto change = [&](std::size_t age) -> const Change& { return changes_[place(age)]; };
    std::array<double, depth> whole{};
    for (std::size_t a = 0; a < known; ++a) {
        for (std::size_t b = a; b < known; ++b) {
            gram[a][b] = gram[b][a] = products_[place(a)][place(b)];
        }
        whole[a] = gram[a][a];
        c[a] = dot(change(a).y, y);
    }
    for (std::size_t k = 0; k < known; ++k) {
        const bool used = gram[k][k] > 1e-10 * whole[k]; // guess: of the path follower
        for (std::size_t a = k + 1; a < known; ++a) {
            const double factor = used ? gram[a][k] / gram[k][k] : 0.0;
            for (std::size_t b = k; b < known; ++b) {
                gram[a][b] -= factor * gram[k][b];
            }
            c[a] -= factor * c[k];
        }
        if (!used) {
            gram[k][k] = 0;
        }
    }
    for (std::size_t k = known; k-- > 0;) {
        for (std::size_t b = k + 1; b < known; ++b) {
            c[k] -= gram[k][b] * c[b];
        }
        c[k] = gram[k][k] > 0 ? c[k] / gram[k][k] : 0.0;
    }
    for (std::size_t k = 0; k < known; ++k) {
        const Change& used = change(k);
        for (std::size_t i = 0; i < y.size(); ++i) {
            y[i] -= c[k] * (used.x[i] + used.y[i]);
        }
    }
    x_ = y;
    ++count_;
}

} // namespace isostat
