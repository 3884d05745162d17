// Families that approach a degeneracy, delta = 1e-1 ... 1e-300 and 0: the answer for either sign of delta, the rung
// that gave it, margin and cost. Prints a table (Markdown); writes degeneracy.csv and, with gnuplot, degeneracy.svg.
// The status is 1 when an answer is wrong, or when the tie at 0 is not one. Usage:
//   bench_degeneracy [folder]

#include "oracle/structures.hpp"
#include "support/crafted.hpp"

#include <isostat/statics/decisions.hpp>
#include <isostat/verified/inverse_bound_multiprecision.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

using namespace isostat;
using namespace crafted;

namespace {

/// What a decision said.
struct Answer {
    int sign = 0; ///< +1 or -1: which of the two; 0: a tie
    Rung rung = Rung::none;
    int bits = 0;
    double margin = 0;
};

struct Statement {
    IsostaticStructure<2> structure;
    Factorisation factorisation;
    InverseBoundCache cache;
    InverseBound inverse;
    VertexEnclosure vertex;
    Statics<2> statics;

    Statement(const State<2>& state, bool truth)
        : structure(std::move(IsostaticStructure<2>::prove(state.packing, state.contacts).value())),
          factorisation(structure), inverse(bound_inverse(structure, factorisation, cache)),
          vertex(enclose_vertex(state.packing, structure, inverse)),
          statics(state.packing, state.load, structure, factorisation, inverse, {}, truth ? &vertex : nullptr) {}
};

/// Unit disks 0 and 1 on the bottom, 2 on top of 0; forces in y on the disks.
State<2> stack(double up0, double up1, double up2) {
    State<2> state = in_box({{1, 1, 1}, {1, 3, 1}, {1, 1, 3}}, 4, 4, 1, 1,
                            {left(0), bottom(0), left(2), pair(0, 2), pair(0, 1), bottom(1), right(1), top(2)});
    state.load.disk_force = {0, up0, 0, up1, 0, up2};
    return state;
}

Answer which_opens(const State<2>& state, const Contact& plus, const Contact& minus) {
    Statement s(state, true);
    const double sigma = state.load.stress[1];
    const auto decision = decide_opening(s.statics, sigma, OpeningRule::most_negative, ContactId(), 0);
    Answer answer{0, s.statics.rung(), s.statics.bits(), 0};
    if (decision.ok() && decision.value().opening) {
        const Contact opened = state.contacts[decision.value().opening->contact.index()];
        answer.sign = opened == plus ? 1 : opened == minus ? -1 : 0;
        answer.margin = decision.value().opening->margin;
    }
    return answer;
}

Answer tractions(double delta) {
    return which_opens(stack(2, 1, delta), bottom(0), bottom(1));
}

Answer limits(double delta) {
    const State<2> state = stack(delta, -1, 0.5);
    Statement s(state, true);
    const auto limit = find_limit(s.statics, 1, -1);
    Answer answer{0, s.statics.rung(), s.statics.bits(), 0};
    if (limit.ok() && limit.value().tie_class.size() == 1) {
        answer.sign = state.contacts[limit.value().opens.index()] == bottom(0) ? 1 : -1;
        answer.margin = limit.value().margin;
    }
    return answer;
}

/// Radii of the two base disks of a notch differ by delta: which side of the small disk lets go. Below 2^-52 the radii
/// themselves are equal.
Answer notch(double delta) {
    const Answer answer = delta >= 0 ? which_opens(three_disks(1, 1 + delta, 0.1, 1, -1), pair(0, 2), pair(1, 2))
                                     : which_opens(three_disks(1 - delta, 1, 0.1, 1, -1), pair(0, 2), pair(1, 2));
    return answer;
}

/// A disk between two fixed ones, delta off collinear: compression on one side, traction on the other. A statement
/// about the stored matrix.
Answer strut(double delta) {
    const oracle::Structure s = oracle::needle(1, delta);
    const auto proved = IsostaticStructure<2>::prove(s.packing, s.contacts);
    if (!proved.ok()) {
        return {0, Rung::exact, 0, 0}; // singular, as it should be at 0
    }
    const Factorisation factorisation(proved.value());
    InverseBoundCache cache;
    InverseBound inverse = bound_inverse(proved.value(), factorisation, cache);
    if (inverse.verdict != Verdict::proved) {
        inverse = bound_inverse_multiprecision(s.packing, proved.value());
    }
    ForceLadder<2> ladder(s.packing, proved.value(), factorisation, inverse);
    ForceExpression e;
    e.contact = ContactId(0);
    e.part = ladder.add({0, 1});
    Order order = ladder.sign(e);
    while (!order.decided && ladder.climb()) {
        order = ladder.sign(e);
    }
    return {order.decided ? order.sign : 0, order.rung, order.bits, order.margin};
}

/// A candidate contact that misses, or overlaps, by about delta at the true vertex.
Answer grazing(double delta) {
    State<2> state = square_lattice(2);
    std::erase(state.contacts, pair(2, 3));
    std::erase(state.contacts, pair(1, 3));
    state.packing.radius[3] = 1 - delta;
    state.packing.q[6] = 3 + delta;
    state.packing.q[7] = 3 + delta;
    Statement s(state, true);
    if (s.vertex.verdict != Verdict::proved) {
        s.vertex = enclose_vertex_double_double(state.packing, s.structure, s.factorisation, s.inverse);
    }
    const Enclosure h = gap_at_vertex(state.packing, s.vertex, pair(2, 3));
    if (h.decided()) {
        return {h.positive() ? 1 : -1, Rung::double_bound, 53, h.margin()};
    }
    s.vertex = enclose_vertex_double_double(state.packing, s.structure, s.factorisation, s.inverse);
    const Enclosure closer = gap_at_vertex(state.packing, s.vertex, pair(2, 3));
    if (closer.decided()) {
        return {closer.positive() ? 1 : -1, Rung::double_double, 106, closer.margin()};
    }
    const Order order = gap_sign_at_vertex(state.packing, s.structure, s.factorisation, s.inverse, pair(2, 3));
    return {order.decided ? order.sign : 0, order.rung, order.bits, order.margin};
}

struct Family {
    const char* name;
    std::function<Answer(double)> ask;
    double smallest; ///< below it, delta is lost in the data themselves
};

struct Line {
    std::string family;
    double delta;
    Answer answer;
    double milliseconds;
};

double milliseconds(const std::function<void()>& work) {
    std::vector<double> times;
    for (int k = 0; k < 5; ++k) {
        const auto begin = std::chrono::steady_clock::now();
        work();
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    }
    return *std::min_element(times.begin(), times.end());
}

std::string rung_text(const Answer& a) {
    return a.rung == Rung::multiprecision ? fmt::format("mpfr {}", a.bits) : std::string(to_string(a.rung));
}

} // namespace

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    const std::vector<Family> families{{"two tractions within delta", tractions, 1e-300},
                                       {"two forces vanish within delta", limits, 1e-300},
                                       {"strut off collinear by delta", strut, 1e-300},
                                       {"notch, radii differ by delta", notch, 3e-16},
                                       {"grazing by delta", grazing, 3e-16}};
    std::vector<double> deltas;
    for (int decade = 1; decade <= 300; decade += decade < 20 ? 1 : decade < 100 ? 10 : 25) {
        deltas.push_back(std::pow(10.0, -decade));
    }
    deltas.push_back(1e-300);
    bool right = true;
    std::vector<Line> lines;
    for (const Family& family : families) {
        const int orientation = family.ask(0.1).sign; // which side is which; all smaller ones must agree
        if (orientation == 0) {
            fmt::print(stderr, "{}: no answer at delta = 0.1\n", family.name);
            right = false;
        }
        for (const double delta : deltas) {
            if (delta < family.smallest) {
                continue;
            }
            const Answer plus = family.ask(delta);
            const Answer minus = family.ask(-delta);
            if (plus.sign != orientation || minus.sign != -orientation) {
                fmt::print(stderr, "{}: delta = +-{:g}: answers {} and {}\n", family.name, delta, plus.sign,
                           minus.sign);
                right = false;
            }
            lines.push_back({family.name, delta, plus, milliseconds([&] { (void)family.ask(delta); })});
        }
        const Answer zero = family.ask(0);
        if (zero.sign != 0) {
            fmt::print(stderr, "{}: delta = 0 is not a tie\n", family.name);
            right = false;
        }
        lines.push_back({family.name, 0, zero, milliseconds([&] { (void)family.ask(0); })});
    }
    fmt::print("| family | delta | decided by | margin | time (ms) |\n|---|---|---|---|---|\n");
    std::filesystem::create_directories(folder);
    std::ofstream csv(folder / "degeneracy.csv");
    csv << "family,delta,sign,rung,bits,margin,milliseconds\n";
    for (const Line& l : lines) {
        const bool tie = l.answer.sign == 0;
        fmt::print("| {} | {:g} | {}{} | {} | {:.3f} |\n", l.family, l.delta, tie ? "tie: " : "", rung_text(l.answer),
                   tie ? std::string("-") : fmt::format("{:.1e}", l.answer.margin), l.milliseconds);
        csv << fmt::format("{},{:g},{},{},{},{:.6g},{:.5f}\n", l.family, l.delta, l.answer.sign,
                           to_string(l.answer.rung), l.answer.bits, l.answer.margin, l.milliseconds);
    }
    csv.close();
    std::ofstream data(folder / "degeneracy.dat");
    for (std::size_t k = 0; k < lines.size(); ++k) {
        if (k > 0 && lines[k].family != lines[k - 1].family) {
            data << "\n\n";
        }
        if (lines[k].delta > 0) {
            data << fmt::format("{} {:.5f} {}\n", -std::log10(lines[k].delta), lines[k].milliseconds,
                                lines[k].answer.rung == Rung::exact ? 5000 : lines[k].answer.bits);
        }
    }
    data.close();
    std::ofstream plot(folder / "degeneracy.gp");
    plot << "set terminal svg size 760,480 font 'sans,13' background 'white'\nset output 'degeneracy.svg'\n"
            "set logscale xy\nset xlabel '-log_{10} delta'\nset ylabel 'time of the decision, vertex included (ms)'\n"
            "set key top left font ',10'\nset grid\nplot \\\n";
    for (std::size_t k = 0; k < families.size(); ++k) {
        plot << fmt::format("  'degeneracy.dat' index {} using 1:2 with linespoints pt 7 ps 0.5 title '{}'{}\n", k,
                            families[k].name, k + 1 == families.size() ? "" : ", \\");
    }
    plot.close();
    const auto here = std::filesystem::current_path();
    std::filesystem::current_path(folder);
    if (std::system("gnuplot degeneracy.gp") != 0) {
        fmt::print(stderr, "no figure: gnuplot failed\n");
    }
    std::filesystem::current_path(here);
    return right ? 0 : 1;
}
