// Tables behind the figures of the paper, from the ensembles that examples/paper/run makes:
//   paper_analyse ENSEMBLES RESULTS      (folders: ENSEMBLES/n100, ENSEMBLES/n225, ...; RESULTS/*.csv,
//   RESULTS/summary.md)
// Intervals are at the level of 95 %: percentile bootstrap over whole samples unless another method is named.
#include "data.hpp"
#include "io/files.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace {

using namespace paper;
using isostat::Estimate;

constexpr int replicates = 2000;
constexpr std::uint64_t seed = 20000;
constexpr double level = 0.95;
/// Range of sigma2/sigma1 that packings of every size go through.
constexpr double window = 1.02;

using Chosen = std::vector<std::size_t>;

/// The same quantity of one size: as a function of chosen samples.
Estimate of_size(const Size& size, const std::function<double(const Chosen&)>& value) {
    return isostat::bootstrap(
        {size.samples.size()}, [&](const auto& chosen) { return value(chosen[0]); }, replicates, seed, level);
}

/// Rearrangements per unit of sigma2/sigma1 between 1 and the window's end, over all chosen samples.
double rate(const Size& size, const Chosen& chosen, double end) {
    double count = 0;
    double way = 0;
    for (const std::size_t s : chosen) {
        count += size.samples[s].rearrangements_below(end);
        way += std::min(size.samples[s].highest_ratio(), end) - 1;
    }
    return count / way;
}

std::vector<double> pooled(const Size& size, const Chosen& chosen, std::vector<double> Sample::*values) {
    std::vector<double> list;
    for (const std::size_t s : chosen) {
        const std::vector<double>& more = size.samples[s].*values;
        list.insert(list.end(), more.begin(), more.end());
    }
    return list;
}

double median(std::vector<double> values) {
    if (values.empty()) {
        return NAN;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double average(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) {
        sum += v;
    }
    return values.empty() ? NAN : sum / static_cast<double>(values.size());
}

std::vector<double> all_of(const Size& size, std::vector<double> Sample::*values) {
    Chosen everything(size.samples.size());
    for (std::size_t s = 0; s < everything.size(); ++s) {
        everything[s] = s;
    }
    return pooled(size, everything, values);
}

std::string text(const Estimate& e) {
    return std::isnan(e.low) ? fmt::format("{:.4g}", e.value)
                             : fmt::format("{:.4g} [{:.4g}, {:.4g}]", e.value, e.low, e.high);
}

std::string cells(const Estimate& e) {
    return fmt::format("{:.5g},{:.5g},{:.5g}", e.value, e.low, e.high);
}

struct Known {
    std::string name, unit;
    Estimate ours;
    double low, high;
    std::string source;
};

std::string verdict(const Known& k) {
    if (std::isnan(k.ours.value) || std::isnan(k.ours.low)) {
        return "cannot be told";
    }
    if (k.ours.low > k.high || k.ours.high < k.low) {
        return "differs";
    }
    const bool sharp = k.ours.high - k.ours.low <= 2 * std::max(k.high - k.low, 0.05 * std::abs(k.high));
    return sharp ? "agrees" : "compatible, not sharp";
}

/// Slope of log(value) against log(n) over some sizes, samples drawn anew within each size.
Estimate exponent(const std::vector<Size>& sizes, int smallest,
                  const std::function<double(const Size&, const Chosen&)>& value) {
    std::vector<const Size*> used;
    std::vector<std::size_t> counts;
    for (const Size& size : sizes) {
        if (size.disks >= smallest && size.samples.size() >= 2) {
            used.push_back(&size);
            counts.push_back(size.samples.size());
        }
    }
    if (used.size() < 2) {
        return {NAN, NAN, NAN};
    }
    const auto slope = [&](const std::vector<Chosen>& chosen) {
        std::vector<double> x;
        std::vector<double> y;
        std::vector<double> weight;
        for (std::size_t g = 0; g < used.size(); ++g) {
            x.push_back(std::log(used[g]->disks));
            y.push_back(std::log(value(*used[g], chosen[g])));
            weight.push_back(static_cast<double>(all_of(*used[g], &Sample::strain).size()));
        }
        return isostat::fit_line(x, y, weight).slope;
    };
    return isostat::bootstrap(counts, slope, replicates, seed, level);
}

/// Staircases and single increments are kept for the two largest sizes only: 1936 and 4900 as in the paper.
int drawn_from(const std::vector<Size>& sizes) {
    return sizes.size() < 2 ? 0 : sizes[sizes.size() - 2].disks;
}

std::string increments_table(const std::vector<Size>& sizes) {
    std::string table = "# n,seed,ratio,arcs,stress_increment,strain_increment\n";
    for (const Size& size : sizes) {
        if (size.disks < drawn_from(sizes)) {
            continue;
        }
        for (const Sample& sample : size.samples) {
            for (const isostat::RearrangementRow& r : sample.loading) {
                table += fmt::format("{},{},{:.7g},{},{:.5g},{:.5g}\n", size.disks, sample.seed, r.ratio, r.arcs,
                                     r.stress_increment.value_or(NAN), r.strain_increment.value_or(NAN));
            }
        }
    }
    return table;
}

/// Complementary distributions, at most 150 points each.
std::string distributions_table(const std::vector<Size>& sizes) {
    std::string table = "# n,kind,x,share_not_smaller: kind 1 stress increments, 2 strain increments, 3 arcs\n";
    for (const Size& size : sizes) {
        int kind = 0;
        for (const auto values : {&Sample::stress, &Sample::strain, &Sample::arcs}) {
            ++kind;
            const auto points = isostat::complementary_distribution(all_of(size, values));
            const std::size_t step = points.size() / 150 + 1;
            for (std::size_t p = 0; p<points.size(); p += p + 20> points.size() ? 1 : step) {
                table += fmt::format("{},{},{:.5g},{:.5g}\n", size.disks, kind, points[p].first, points[p].second);
            }
        }
    }
    return table;
}

/// Histograms of the two largest sizes on linear axes: stress to 5 means in 25 bins, strain to 20 medians in 40.
std::string histograms_table(const std::vector<Size>& sizes) {
    std::string table = "# n,kind,centre,density: kind 1 stress increments, 2 strain increments\n";
    for (const Size& size : sizes) {
        if (size.disks < drawn_from(sizes)) {
            continue;
        }
        const std::vector<double> stress = all_of(size, &Sample::stress);
        const std::vector<double> strain = all_of(size, &Sample::strain);
        for (const auto& [centre, density] : isostat::histogram(stress, 0, 5 * average(stress), 25)) {
            table += fmt::format("{},1,{:.5g},{:.5g}\n", size.disks, centre, density);
        }
        for (const auto& [centre, density] : isostat::histogram(strain, 0, 20 * median(strain), 40)) {
            table += fmt::format("{},2,{:.5g},{:.5g}\n", size.disks, centre, density);
        }
    }
    return table;
}

std::string staircase_table(const std::vector<Size>& sizes) {
    std::string table = "# n,seed,segment,number,previous,eps2,ratio\n";
    for (const Size& size : sizes) {
        if (size.disks < drawn_from(sizes)) {
            continue;
        }
        // The first sample that came through the whole programme, else the first one.
        const auto whole =
            std::find_if(size.samples.begin(), size.samples.end(), [](const Sample& s) { return s.completed; });
        const Sample& sample = whole == size.samples.end() ? size.samples.front() : *whole;
        int segment = -1;
        for (const isostat::EquilibriumRow& row : sample.rows) {
            if (row.segment != segment) {
                segment = row.segment; // it begins where it branches off
                const auto from = std::find_if(sample.rows.begin(), sample.rows.end(),
                                               [&](const auto& r) { return r.number == row.previous; });
                if (from != sample.rows.end()) {
                    table += fmt::format("{},{},{},{},{},{:.8g},{:.10g}\n", size.disks, sample.seed, segment,
                                         from->number, from->previous, from->strain2, from->ratio);
                }
            }
            table += fmt::format("{},{},{},{},{},{:.8g},{:.10g}\n", size.disks, sample.seed, row.segment, row.number,
                                 row.previous, row.strain2, row.ratio);
        }
    }
    return table;
}

std::string hysteresis_table(const std::vector<Size>& sizes) {
    std::string table = "# n,seed,from,amplitude,peak_eps2,left_eps2\n";
    for (const Size& size : sizes) {
        for (const Sample& sample : size.samples) {
            for (const Cycle& c : sample.cycles) {
                table += fmt::format("{},{},{},{:.7g},{:.6g},{:.6g}\n", size.disks, sample.seed, c.from, c.amplitude,
                                     c.peak, c.left);
            }
        }
    }
    return table;
}

/// Mean over the chosen samples of what is left, for the cycles that start at one equilibrium (0: at the highest load).
double left_share(const Size& size, const Chosen& chosen, int from) {
    double left = 0;
    double peak = 0;
    for (const std::size_t s : chosen) {
        for (const Cycle& c : size.samples[s].cycles) {
            if (c.from == from) {
                left += c.left;
                peak += c.peak;
            }
        }
    }
    return peak > 0 ? left / peak : NAN;
}

/// Exponent p of left strain ~ amplitude^p over the cycles of the chosen samples.
double hysteresis_power(const Size& size, const Chosen& chosen, double Cycle::*what) {
    std::vector<double> x;
    std::vector<double> y;
    for (const std::size_t s : chosen) {
        for (const Cycle& c : size.samples[s].cycles) {
            if (c.amplitude > 0 && c.*what > 0) {
                x.push_back(std::log(c.amplitude));
                y.push_back(std::log(c.*what));
            }
        }
    }
    return x.size() < 3 ? NAN : isostat::fit_line(x, y, std::vector<double>(x.size(), 1.0)).slope;
}

class Analysis {
  public:
    explicit Analysis(std::vector<Size> sizes) : sizes_(std::move(sizes)) {}

    /// One block per size: what was run and what came out.
    std::string sizes_table() {
        std::string table =
            "# n,samples,completed,undecided_or_failed,rearrangements,window_end,rate,rate_low,rate_high,"
            "mean_stress_increment,low,high,median_strain_increment,low,high,strain_exponent,low,high,"
            "strain_ks,exponential_p,single_arc_share,low,high,arcs_exponent,low,high,phi,low,high\n";
        for (const Size& size : sizes_) {
            const std::vector<double> strain = all_of(size, &Sample::strain);
            const std::vector<double> stress = all_of(size, &Sample::stress);
            const double low = median(strain);
            const double high = 1000 * low;
            const auto strain_law = [&](const Chosen& chosen) {
                return isostat::truncated_power_law(pooled(size, chosen, &Sample::strain), low, high);
            };
            const auto arcs_law = [&](const Chosen& chosen) {
                return isostat::truncated_power_law(pooled(size, chosen, &Sample::arcs), 5, 1000);
            };
            const auto single = [&](const Chosen& chosen) {
                const std::vector<double> arcs = pooled(size, chosen, &Sample::arcs);
                return static_cast<double>(std::count(arcs.begin(), arcs.end(), 1.0)) /
                       static_cast<double>(arcs.size());
            };
            const auto mean_stress = [&](const Chosen& chosen) {
                return average(pooled(size, chosen, &Sample::stress));
            };
            const auto middle = [&](const Chosen& chosen) { return median(pooled(size, chosen, &Sample::strain)); };
            std::vector<double> phi;
            for (const Sample& sample : size.samples) {
                phi.push_back(sample.rows.front().solid_fraction);
            }
            const Estimate law = of_size(size, strain_law);
            table += fmt::format(
                "{},{},{},{},{},{},{},{},{},{},{:.3g},{:.3g},{},{},{}\n", size.disks, size.samples.size(),
                size.completed(), size.samples.size() - size.completed(), strain.size(), window,
                cells(of_size(size, [&](const Chosen& c) { return rate(size, c, window); })),
                cells(of_size(size, mean_stress)), cells(of_size(size, middle)), cells(law),
                isostat::power_law_distance(strain, low, high, law.value),
                stress.size() > 10 ? isostat::exponential_p_value(stress, 1000, seed) : NAN,
                cells(of_size(size, single)), cells(of_size(size, arcs_law)), cells(isostat::mean_with_t(phi, level)));
        }
        return table;
    }

    /// What is known, and what came out.
    std::vector<Known> comparisons() {
        std::vector<Known> list;
        const auto in_window = [](const Size& size, const Chosen& chosen) { return 1 / rate(size, chosen, window); };
        const auto in_large_window = [](const Size& size, const Chosen& chosen) {
            return 1 / rate(size, chosen, 1.05);
        };
        const auto mid = [](const Size& size, const Chosen& chosen) {
            return median(pooled(size, chosen, &Sample::strain));
        };
        list.push_back({"mean stress increment ~ n^a, σ₂/σ₁ < 1.02, all sizes", "", exponent(sizes_, 0, in_window),
                        -1.2, -1.1, "literature, from memory: -1.16 ± 0.04"});
        list.push_back({"the same, n ≥ 484", "", exponent(sizes_, 484, in_window), -1.2, -1.1,
                        "literature, from memory: -1.16 ± 0.04"});
        list.push_back({"the same, n ≥ 1024", "", exponent(sizes_, 1024, in_window), -1.2, -1.1,
                        "literature, from memory: -1.16 ± 0.04"});
        list.push_back({"the same, σ₂/σ₁ < 1.05, n ≥ 225", "", exponent(sizes_, 225, in_large_window), -1.2, -1.1,
                        "literature, from memory: -1.16 ± 0.04"});
        list.push_back({"median strain increment ~ n^a, all sizes", "", exponent(sizes_, 0, mid), NAN, NAN, "none"});
        for (const Size& size : sizes_) {
            if (size.samples.size() < 2) {
                continue;
            }
            const std::string at = fmt::format("n = {}", size.disks);
            const double low = median(all_of(size, &Sample::strain));
            list.push_back({"strain increments: density ~ x^-a over 3 decades above the median, " + at, "",
                            of_size(size,
                                    [&](const Chosen& c) {
                                        return isostat::truncated_power_law(pooled(size, c, &Sample::strain), low,
                                                                            1000 * low);
                                    }),
                            1.2, 1.5, "literature, from memory: 1.46 ± 0.03"});
        }
        for (const Size& size : sizes_) {
            std::vector<double> fraction;
            std::vector<double> rattlers;
            for (const Sample& sample : size.samples) {
                fraction.push_back(sample.rows.front().solid_fraction);
                rattlers.push_back(static_cast<double>(sample.rows.front().rattlers) / size.disks);
            }
            const std::string at = fmt::format(" at the start (Student), n = {}", size.disks);
            const double known = size.disks == 100 ? 0.802 : size.disks == 1936 ? 0.8355 : NAN;
            list.push_back({"solid fraction" + at, "", isostat::mean_with_t(fraction, level), known - 0.001,
                            known + 0.001, std::isnan(known) ? "none" : "an independent program"});
            list.push_back({"share of rattlers" + at, "", isostat::mean_with_t(rattlers, level), 0.05, 0.07,
                            "an independent program: 5 to 7 %"});
        }
        for (const Size& size : sizes_) {
            if (size.disks < 400 || size.samples.size() < 2) {
                continue;
            }
            const std::string at = fmt::format("n = {}", size.disks);
            list.push_back({"share of single arcs among rearrangements, " + at, "",
                            of_size(size,
                                    [&](const Chosen& c) {
                                        const auto arcs = pooled(size, c, &Sample::arcs);
                                        return static_cast<double>(std::count(arcs.begin(), arcs.end(), 1.0)) /
                                               static_cast<double>(arcs.size());
                                    }),
                            0.45, 0.55, "an independent program: one half"});
            list.push_back({"number of arcs: density ~ x^-a from 5 to 1000, " + at, "",
                            of_size(size,
                                    [&](const Chosen& c) {
                                        return isostat::truncated_power_law(pooled(size, c, &Sample::arcs), 5, 1000);
                                    }),
                            1.4, 1.6, "an independent program: 1.5"});
        }
        for (const Size& size : sizes_) {
            if (size.disks < 1900) {
                continue;
            }
            const std::string at = fmt::format("n = {}", size.disks);
            std::vector<double> ratio;
            std::vector<double> strain;
            for (const Sample& sample : size.samples) {
                if (const auto* last = sample.last_of_loading(95)) {
                    ratio.push_back(last->ratio);
                    strain.push_back(last->strain2);
                }
            }
            const bool same = size.disks == 1936;
            list.push_back({"σ₂/σ₁ after 95 equilibria (Student), " + at, "", isostat::mean_with_t(ratio, level),
                            same ? 1.07 : NAN, same ? 1.09 : NAN,
                            same ? "an independent program, three samples, 100 equilibria" : "none"});
            list.push_back({"ε₂ after 95 equilibria (Student), " + at, "", isostat::mean_with_t(strain, level),
                            same ? 0.0014 : NAN, same ? 0.0022 : NAN,
                            same ? "an independent program, three samples, 100 equilibria" : "none"});
            list.push_back({"share of the strain that is left after unloading from 95, " + at, "",
                            of_size(size, [&](const Chosen& c) { return left_share(size, c, 0); }), same ? 0.44 : NAN,
                            same ? 0.49 : NAN, same ? "an independent program, three samples" : "none"});
            for (const int from : {5, 10, 15, 20, 40, 70}) {
                list.push_back({fmt::format("the same from {}, {}", from, at), "",
                                of_size(size, [&](const Chosen& c) { return left_share(size, c, from); }), NAN, NAN,
                                "left open by the paper"});
            }
            list.push_back({"peak strain ~ amplitude^p, " + at, "",
                            of_size(size, [&](const Chosen& c) { return hysteresis_power(size, c, &Cycle::peak); }),
                            NAN, NAN, "left open by the paper"});
            list.push_back({"strain left ~ amplitude^p, " + at, "",
                            of_size(size, [&](const Chosen& c) { return hysteresis_power(size, c, &Cycle::left); }),
                            NAN, NAN, "left open by the paper"});
        }
        return list;
    }

    std::string summary(const std::vector<Known>& list, const std::string& how) {
        std::string page =
            "# The paper's biaxial test: what was run and what came out\n\n" + how +
            "\n| n | samples | went through | stress increments | strain increments | equilibria proved | "
            "seeds |\n|---|---|---|---|---|---|---|\n";
        for (const Size& size : sizes_) {
            long proved = 0;
            long rows = 0;
            for (const Sample& sample : size.samples) {
                rows += static_cast<long>(sample.rows.size());
                proved += std::count_if(sample.rows.begin(), sample.rows.end(), [](auto& r) { return r.proved; });
            }
            page += fmt::format("| {} | {} | {} | {} | {} | {} of {} | {} to {} |\n", size.disks, size.samples.size(),
                                size.completed(), all_of(size, &Sample::stress).size(),
                                all_of(size, &Sample::strain).size(), proved, rows, size.samples.front().seed,
                                size.samples.back().seed);
        }
        page += "\nIncrements are those of the loading. Intervals: 95 %, percentile bootstrap over whole samples (2000 "
                "replicates) unless another method is named; with five or seven samples they are too narrow by some "
                "15 %.\n\n| quantity | here | reference | which | verdict |\n|---|---|---|---|---|\n";
        for (const Known& k : list) {
            const bool known = !std::isnan(k.low);
            page += fmt::format("| {} | {} | {} | {} | {} |\n", k.name, text(k.ours),
                                known ? fmt::format("{:g} to {:g}", k.low, k.high) : "–", k.source,
                                known ? verdict(k) : (std::isnan(k.ours.low) ? "cannot be told" : "measured here"));
        }
        for (const Size& size : sizes_) {
            for (const Sample& sample : size.samples) {
                if (!sample.completed && size.disks > 1000) {
                    page += fmt::format("\nn = {}, seed {}: {}\n", size.disks, sample.seed, sample.status);
                }
            }
        }
        return page;
    }

    [[nodiscard]] const std::vector<Size>& sizes() const { return sizes_; }

  private:
    std::vector<Size> sizes_;
};

std::string known_table(const std::vector<Known>& list) {
    std::string table = "# quantity,value,low,high,reference_low,reference_high,source,verdict\n";
    for (const Known& k : list) {
        table += fmt::format("\"{}\",{},{:g},{:g},\"{}\",\"{}\"\n", k.name, cells(k.ours), k.low, k.high, k.source,
                             std::isnan(k.low) ? "" : verdict(k));
    }
    return table;
}

} // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv,
                                             argv + argc); // NOLINT(cppcoreguidelines-pro-bounds-pointer-arithmetic)
    if (arguments.size() < 3) {
        std::cerr << "usage: paper_analyse ENSEMBLES RESULTS [HOW IT WAS MADE]\n";
        return isostat::Error(isostat::ErrorKind::usage, "").exit_status();
    }
    try {
        const std::filesystem::path results = arguments[2];
        Analysis analysis(read_sizes(arguments[1]));
        isostat::make_directory(results);
        const auto write = [&](const char* name, const std::string& content) {
            isostat::write_atomically(results / name, content);
        };
        write("increments.csv", increments_table(analysis.sizes()));
        write("distributions.csv", distributions_table(analysis.sizes()));
        write("histograms.csv", histograms_table(analysis.sizes()));
        write("staircase.csv", staircase_table(analysis.sizes()));
        write("hysteresis.csv", hysteresis_table(analysis.sizes()));
        write("sizes.csv", analysis.sizes_table());
        const std::vector<Known> list = analysis.comparisons();
        write("comparison.csv", known_table(list));
        const std::string page = analysis.summary(list, arguments.size() > 3 ? arguments[3] + "\n" : "");
        write("summary.md", page);
        std::cout << page;
    } catch (const isostat::Error& error) {
        std::cerr << "paper_analyse: " << error.what() << '\n';
        return error.exit_status();
    }
    return 0;
}
