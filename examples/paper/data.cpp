#include "data.hpp"

#include "io/files.hpp"

#include <isostat/core/result.hpp>

#include <algorithm>
#include <regex>

namespace paper {

namespace fs = std::filesystem;
using isostat::EquilibriumRow;

namespace {

/// "status" of run.json: its only line with that key.
std::string status_of(const fs::path& run) {
    const std::string text = isostat::read_text(run);
    std::smatch found;
    static const std::regex line("\"status\": \"([^\\n]*)\",\\n");
    if (!std::regex_search(text, found, line)) {
        return "unknown";
    }
    return std::regex_replace(found[1].str(), std::regex(R"(\\(.))"), "$1"); // escapes of JSON
}

std::vector<Cycle> cycles_of(const Sample& sample) {
    std::vector<Cycle> list;
    const int segments = sample.rows.back().segment + 1;
    for (int s = 1; s < segments; ++s) {
        const auto in_segment = [s](const EquilibriumRow& row) { return row.segment == s; };
        const auto first = std::find_if(sample.rows.begin(), sample.rows.end(), in_segment);
        const auto last = std::find_if(sample.rows.rbegin(), sample.rows.rend(), in_segment);
        if (first == sample.rows.end() || last->ratio != 1) {
            continue; // it did not come back
        }
        const auto from = std::find_if(sample.rows.begin(), sample.rows.end(),
                                       [&](const EquilibriumRow& row) { return row.number == first->previous; });
        const bool end_of_loading = s == 1;
        list.push_back({end_of_loading ? 0 : from->number, from->ratio - 1, from->strain2, last->strain2});
    }
    return list;
}

Sample read_sample(const fs::path& folder) {
    Sample sample;
    sample.seed = std::stoul(folder.filename().string().substr(std::string("seed_").size()));
    sample.status = status_of(folder / "run.json");
    sample.completed = sample.status == "completed";
    sample.rows = isostat::read_equilibria(folder / "equilibria.csv");
    for (const isostat::RearrangementRow& one : isostat::rearrangements(sample.rows)) {
        if (one.segment != 0) {
            continue;
        }
        sample.loading.push_back(one);
        sample.arcs.push_back(one.arcs);
        if (one.stress_increment) {
            sample.stress.push_back(*one.stress_increment);
        }
        if (one.strain_increment) {
            sample.strain.push_back(*one.strain_increment);
        }
    }
    if (!sample.rows.empty()) {
        sample.cycles = cycles_of(sample);
    }
    return sample;
}

} // namespace

double Sample::rearrangements_below(double end) const {
    return static_cast<double>(
        std::count_if(loading.begin(), loading.end(), [end](const auto& r) { return r.ratio <= end; }));
}

double Sample::highest_ratio() const {
    double highest = 1;
    for (const EquilibriumRow& row : rows) {
        highest = row.segment == 0 ? std::max(highest, row.ratio) : highest;
    }
    return highest;
}

const EquilibriumRow* Sample::last_of_loading(int number) const {
    const auto found = std::find_if(
        rows.begin(), rows.end(), [&](const EquilibriumRow& row) { return row.segment == 0 && row.number == number; });
    return found == rows.end() ? nullptr : &*found;
}

std::size_t Size::completed() const {
    return static_cast<std::size_t>(
        std::count_if(samples.begin(), samples.end(), [](const Sample& s) { return s.completed; }));
}

std::vector<Size> read_sizes(const fs::path& ensembles) {
    std::vector<Size> sizes;
    if (!fs::is_directory(ensembles)) {
        throw isostat::Error(isostat::ErrorKind::bad_input,
                             ensembles.string() + ": does not exist: expected a folder with n100, n225, ...");
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(ensembles)) {
        const std::string name = entry.path().filename().string();
        static const std::regex pattern("n[0-9]+");
        if (!std::regex_match(name, pattern)) {
            continue;
        }
        Size size;
        size.disks = std::stoi(name.substr(1));
        for (const fs::directory_entry& sample : fs::directory_iterator(entry.path() / "samples")) {
            if (fs::exists(sample.path() / "run.json") && fs::exists(sample.path() / "equilibria.csv")) {
                Sample one = read_sample(sample.path());
                if (!one.rows.empty()) {
                    size.samples.push_back(std::move(one));
                }
            }
        }
        std::sort(size.samples.begin(), size.samples.end(),
                  [](const Sample& a, const Sample& b) { return a.seed < b.seed; });
        if (!size.samples.empty()) {
            sizes.push_back(std::move(size));
        }
    }
    std::sort(sizes.begin(), sizes.end(), [](const Size& a, const Size& b) { return a.disks < b.disks; });
    return sizes;
}

} // namespace paper
