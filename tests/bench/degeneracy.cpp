// Families that approach a degeneracy, delta = 1e-1 ... 1e-300 and 0: the answer for either sign of delta, the rung
// that gave it, the proved relative error of what was compared, and the CPU time (median and range). Writes
// degeneracy.csv and, with gnuplot, degeneracy.svg into the folder. The status is 1 when an answer is wrong, or when
// the tie at 0 is not one. Usage:
//   bench_degeneracy [--json FILE] [folder]

#include "bench/shared/report.hpp"
#include "support/families.hpp"

using namespace isostat;
using families::Answer;

namespace {

struct Family {
    const char* name;
    std::function<Answer(int sign, int decade)> ask; ///< delta = sign * 10^-decade, 0 for the decade 0
    int last;                                        ///< decade from which delta is lost in the data themselves
    int repeats;
};

std::function<Answer(int, int)> of_double(Answer (*ask)(double)) {
    return [ask](int sign, int decade) { return ask(decade == 0 ? 0.0 : sign * std::pow(10.0, -decade)); };
}

struct Line {
    std::string family;
    int decade; ///< 0: delta = 0
    Answer answer;
    bench::Sample milliseconds;
};

std::string rung_text(const Answer& a) {
    return a.rung == Rung::multiprecision ? fmt::format("mpfr {}", a.bits) : std::string(to_string(a.rung));
}

std::string text_of(int decade) {
    return decade == 0 ? "0" : fmt::format("1e-{}", decade);
}

} // namespace

int main(int argc, char** argv) {
    std::string where = ".";
    bench::Program program("bench_degeneracy", "families that approach a degeneracy: answer, rung, time");
    program.option("folder", where, "for degeneracy.csv and the figure");
    program.parse(argc, argv);
    const std::filesystem::path folder = where;
    constexpr int all = 300, of_doubles = 15;
    using namespace families;
    const std::vector<::Family> list{{"two tractions within delta", of_double(tractions), all, 5},
                                     {"two forces vanish within delta", of_double(limits), all, 5},
                                     {"strut off collinear by delta", of_double(strut), all, 5},
                                     {"notch, radii differ by delta", of_double(notch), of_doubles, 5},
                                     {"notch, exact coordinates", exact_notch, all, 2},
                                     {"grazing by delta", of_double(grazing), of_doubles, 5},
                                     {"grazing, exact coordinates", exact_grazing, all, 2},
                                     {"two gaps close within delta (arc)", of_double(closings), of_doubles, 2},
                                     {"two gaps close, exact coordinates", exact_closings, all, 2},
                                     {"end of three disks, R3 = R(1 + delta) (arc)", of_double(ends), of_doubles, 2},
                                     {"end of two disks, exact coordinates", exact_ends, all, 2},
                                     {"lattice, radii differ by delta, exact", exact_lattice, all, 2}};
    std::vector<int> decades;
    for (int decade = 1; decade <= all; decade += decade < 20 ? 1 : decade < 100 ? 10 : 25) {
        decades.push_back(decade);
    }
    bool right = true;
    std::vector<Line> lines;
    std::vector<std::size_t> family_of;
    for (std::size_t f = 0; f < list.size(); ++f) {
        const Family& family = list[f];
        const int orientation = family.ask(+1, 1).sign; // which side is which; all smaller ones must agree
        if (orientation == 0) {
            fmt::print(stderr, "{}: no answer at delta = 0.1: {}\n", family.name, family.ask(+1, 1).why);
            right = false;
        }
        const auto time = [&](int decade) {
            return bench::milliseconds([&] { (void)family.ask(+1, decade); }, family.repeats);
        };
        for (const int decade : decades) {
            if (decade > family.last) {
                continue;
            }
            const Answer plus = family.ask(+1, decade);
            const Answer minus = family.ask(-1, decade);
            if (plus.sign != orientation || minus.sign != -orientation) {
                fmt::print(stderr, "{}: delta = +-1e-{}: answers {} ({}) and {} ({})\n", family.name, decade, plus.sign,
                           plus.why, minus.sign, minus.why);
                right = false;
            }
            lines.push_back({family.name, decade, plus, time(decade)});
            family_of.push_back(f);
        }
        const Answer zero = family.ask(+1, 0);
        if (zero.sign != 0 || zero.rung == Rung::none) {
            fmt::print(stderr, "{}: delta = 0 is not a tie: {}\n", family.name, zero.why);
            right = false;
        }
        lines.push_back({family.name, 0, zero, time(0)});
        family_of.push_back(f);
    }
    bench::Table table("degeneracy", "Families that approach a degeneracy:",
                       {{"family", "family", ""},
                        {"delta", "δ", ""},
                        {"rung", "decided by", ""},
                        {"error", "error / quantity", "", "{:.1e}"},
                        {"time", "time, ms", "ms", "{:.3f}"}});
    std::filesystem::create_directories(folder);
    std::ofstream csv(folder / "degeneracy.csv");
    csv << "family,delta,sign,rung,bits,error,milliseconds\n";
    for (const Line& l : lines) {
        const bool tie = l.answer.sign == 0;
        const double error = tie ? 0.0 : 1 / l.answer.margin;
        table.add({l.family, text_of(l.decade), (tie ? "tie: " : "") + rung_text(l.answer),
                   tie ? bench::Cell() : bench::Cell(error), l.milliseconds});
        csv << fmt::format("\"{}\",{},{},{},{},{:.6g},{:.5f}\n", l.family, text_of(l.decade), l.answer.sign,
                           to_string(l.answer.rung), l.answer.bits, error, l.milliseconds.median());
    }
    program.show(table);
    csv.close();
    std::ofstream data(folder / "degeneracy.dat");
    for (std::size_t k = 0; k < lines.size(); ++k) {
        if (k > 0 && family_of[k] != family_of[k - 1]) {
            data << "\n\n";
        }
        if (lines[k].decade > 0) {
            data << fmt::format("{} {:.5f} {:.6g}\n", lines[k].decade, lines[k].milliseconds.median(),
                                1 / lines[k].answer.margin);
        }
    }
    data.close();
    const auto curves = [&](const char* columns, bool titles, bool with_exact) {
        std::string text;
        for (std::size_t k = 0; k < list.size(); ++k) {
            const bool exact = std::string(list[k].name).find("exact") != std::string::npos;
            if (exact && !with_exact) {
                continue;
            }
            const std::size_t point = 2 * (k % 5) + (exact ? 4 : 5); // open or filled
            text +=
                fmt::format("{}  'degeneracy.dat' index {} using {} with linespoints pt {} ps 0.5 lc {}{} {}",
                            text.empty() ? "plot \\\n" : ", \\\n", k, columns, point, k % 8 + 1, exact ? " dt 2" : "",
                            titles ? fmt::format("title '{}'", list[k].name) : std::string("notitle"));
        }
        return text + "\n";
    };
    bench::draw(
        folder, "degeneracy",
        std::string("set terminal svg size 900,640 font 'sans,12' background 'white'\nset output 'degeneracy.svg'\n"
                    "set multiplot\nset logscale xy\nset xrange [1:300]\nset grid\nset lmargin at screen 0.09\n"
                    "set rmargin at screen 0.62\nset format y '10^{%T}'\nset key at screen 0.64, screen 0.95 left Left "
                    "reverse font ',10'\n"
                    "set tmargin at screen 0.97\nset bmargin at screen 0.56\nset ylabel 'time, vertex or arc included "
                    "(ms)'\n") +
            curves("1:2", true, true) +
            "set tmargin at screen 0.47\nset bmargin at screen 0.09\nset xlabel '-log_{10} delta'\n"
            "set ylabel 'proved error / quantity'\nset label 'exact coordinates: error 0' at graph 0.03, graph 0.15\n" +
            curves("1:($3 > 0 ? $3 : NaN)", false, false) + "unset multiplot\n");
    return program.finish(right);
}
