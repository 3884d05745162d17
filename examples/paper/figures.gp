# gnuplot script: the figures of the paper and their log-log views, from the tables in this folder (results/).
# Sizes that were not run are left out.
set encoding utf8
set datafile separator ","
set grid back lt 1 lw 0.5 lc rgb "#dddddd"
set key font ",11" samplen 2
# Dark to light, and another line for each: they are told apart in grey print too.
array dash[8] = [1, 2, 4, 5, 3, 1, 2, 4]
array shape[8] = [7, 5, 9, 7, 5, 9, 7, 5] # one below: the same, open
# Quantities of each size are looked up once: functions that call programs would be called for every point.
array colour[8] = ["#12365a", "#e07b1a", "#3f9a5c", "#8a4fb0", "#c2a000", "#a61c3c", "#2f8f9d", "#555555"]
first_column(file) = system(sprintf("grep -v '^#' %s | cut -d, -f1 | sort -nu | tr '\\n' ' '", file))
sizes = first_column("sizes.csv")
large = first_column("staircase.csv")
cycles = system("awk -F, '$3>=2 && $3<=4 {print $1}' staircase.csv | sort -nu | tr '\\n' ' '")
count(n, column) = system(sprintf("awk -F, '$1==%d && $%d != \"nan\"' increments.csv | wc -l", n, column))
stress_counts = ""
strain_counts = ""
do for [n in large] {
  stress_counts = stress_counts." ".count(n+0, 5)
  strain_counts = strain_counts." ".count(n+0, 6)
}
means = system("grep -v '^#' sizes.csv | cut -d, -f10 | tr '\\n' ' '")
array mean[8]
do for [i=1:words(sizes)] { mean[i] = real(word(means, i)) }

set terminal svg size 1100,480 dynamic font "sans,13" background "#ffffff"
set output "figure2.svg"
set multiplot layout 1,2
set format x "%g"
set rmargin 3
set key top left reverse Left
set xlabel "axial strain 10^{4} ε_2"
set ylabel "stress ratio σ_2/σ_1"
do for [n in large] {
  set title sprintf("%s disks: loading%s, then unloading", n, n > 1900 ? " over 95 equilibria" : " to 1.1")
  plot "staircase.csv" using ($1==n+0 && $3==0 ? 1e4*$6 : NaN):7 with fsteps lw 1.5 dt dash[1] lc rgb colour[1] title "loading", \
       "" using ($1==n+0 && $3==1 ? 1e4*$6 : NaN):7 with fsteps lw 1.5 dt dash[2] lc rgb colour[2] title "unloading"
}
unset multiplot

if (words(cycles) > 0) {
set output "figure3.svg"
set multiplot layout 1,2
do for [n in cycles] {
  set title sprintf("%s disks: unloading from equilibria 10, 15 and 20", n)
  plot "staircase.csv" using ($1==n+0 && $3==0 && $4<=20 ? 1e4*$6 : NaN):7 with fsteps lw 1.5 dt dash[1] lc rgb colour[1] title "loading", \
       "" using ($1==n+0 && $3==2 ? 1e4*$6 : NaN):7 with fsteps lw 1.5 dt dash[2] lc rgb colour[2] title "from 10", \
       "" using ($1==n+0 && $3==3 ? 1e4*$6 : NaN):7 with fsteps lw 1.5 dt dash[3] lc rgb colour[3] title "from 15", \
       "" using ($1==n+0 && $3==4 ? 1e4*$6 : NaN):7 with fsteps lw 1.5 dt dash[4] lc rgb colour[4] title "from 20"
}
unset multiplot
}

# Figures 4 and 5: histograms as in the paper; complementary distributions, which need no bins, on the scales of the laws.
set terminal svg size 1100,480 dynamic font "sans,13" background "#ffffff"
set output "figure4.svg"
set multiplot layout 1,2
set key top right noreverse Right
set title "Stress increments of the loading"
set xlabel "stress increment 10^{3} Δσ_2/σ_1"
set ylabel "density"
set xrange [0:*]
plot for [i=1:words(large)] "histograms.csv" using ($1==word(large,i)+0 && $2==1 ? 1e3*$3 : NaN):4 with histeps lw 1.5 dt dash[i] lc rgb colour[i] title sprintf("%s disks, %s values", word(large,i), word(stress_counts,i))
set title "Share of the increments ≥ x: straight lines are exponential laws"
set autoscale x
set xrange [0:*]
set logscale y
set ylabel "share"
set xlabel "stress increment divided by its mean"
set xrange [0:8]
set yrange [1e-3:1.2]
plot for [i=1:words(sizes)] "distributions.csv" using ($1==word(sizes,i)+0 && $2==1 ? $3/(mean[i]) : NaN):4 with steps lw 1.5 dt dash[i] lc rgb colour[i] title word(sizes,i)." disks", \
     exp(-x) dt 2 lc rgb "#000000" title "exp(-x)"
unset multiplot

set output "figure5.svg"
set multiplot layout 1,2
unset logscale
set autoscale
set title "Strain increments of the loading"
set xlabel "strain increment 10^{6} Δε_2"
set ylabel "density / 10^{6}"
set xrange [0:10]
set logscale y
set format y "10^{%L}"
plot for [i=1:words(large)] "histograms.csv" using ($1==word(large,i)+0 && $2==2 ? 1e6*$3 : NaN):(1e-6*$4) with histeps lw 1.5 dt dash[i] lc rgb colour[i] title sprintf("%s disks, %s values", word(large,i), word(strain_counts,i))
set format y "% h"
set title "Share of the increments ≥ x"
set xlabel "strain increment Δε_2"
set autoscale x
set xrange [1e-9:0.1]
set yrange [5e-4:1.5]
set logscale xy
set format x "10^{%L}"
set xtics 100
set ylabel "share"
set key bottom left
plot for [i=1:words(sizes)] "distributions.csv" using ($1==word(sizes,i)+0 && $2==2 ? $3 : NaN):4 with steps lw 1.5 dt dash[i] lc rgb colour[i] title word(sizes,i)." disks", \
     [1e-6:1e-2] 5e-4*x**-0.46 dt 2 lc rgb "#000000" title "x^{-0.46}"
unset multiplot

set output "sizes.svg"
set multiplot layout 1,2
set title "Rearrangements per unit of σ_2 / σ_1, between 1 and 1.02"
set format x "%g"
set xtics autofreq
set xtics (100, 200, 500, 1000, 2000, 5000)
set xlabel "disks"
set ylabel "rearrangements per unit of σ_2/σ_1"
set autoscale
set xrange [70:7000]
set key top left
plot "sizes.csv" using 1:7:8:9 with yerrorbars pt 7 ps 0.6 lw 1.5 lc rgb colour[1] title "measured, 95 %", \
     0.15*x**1.16 dt 2 lc rgb "#000000" title "n^{1.16}"
set title "Median strain increment of the loading"
set ylabel "strain increment Δε_2"
set format y "10^{%L}"
set key top right
plot "sizes.csv" using 1:13:14:15 with yerrorbars pt 7 ps 0.6 lw 1.5 lc rgb colour[2] title "measured, 95 %", \
     1.5*x**-2 dt 2 lc rgb "#000000" title "n^{-2}"
unset multiplot

set output "hysteresis.svg"
first = words(sizes) > 3 ? 4 : 1 # small sizes scatter too much to be drawn
set multiplot layout 1,2
set title "Strain at the top of a cycle (filled) and what is left of it (open)"
set xlabel "amplitude: σ_2/σ_1 - 1 at the top"
set ylabel "axial strain ε_2"
set autoscale
set xrange [1e-4:0.2]
set xtics autofreq
set format x "10^{%L}"
set key top left
plot for [i=first:words(sizes)] "hysteresis.csv" using ($1==word(sizes,i)+0 ? $4 : NaN):5 with points pt shape[i] ps 0.6 lc rgb colour[i] title word(sizes,i)." disks", \
     for [i=first:words(sizes)] "hysteresis.csv" using ($1==word(sizes,i)+0 ? $4 : NaN):6 with points pt shape[i]-1 ps 0.8 lc rgb colour[i] notitle
set title "Share of the strain that is left"
unset logscale y
set format y "%g"
set yrange [0:1.5]
set ylabel "strain left / peak strain"
plot for [i=first:words(sizes)] "hysteresis.csv" using ($1==word(sizes,i)+0 ? $4 : NaN):($6/$5) with points pt shape[i] ps 0.6 lc rgb colour[i] title word(sizes,i)." disks"
unset multiplot
