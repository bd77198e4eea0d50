# Plots of report.sh, from plot.dat (prior axis level variant points sd ate sd) of the folder it runs in.
set terminal svg size 760,440 background 'white' enhanced font 'sans,12'
set key outside right
set grid
set logscale y
array color[6] = ['#999999', '#c9a227', '#1f5fa8', '#3aa6a0', '#e0301f', '#8e3d8e']
noise = 20 # mm, of a range
rows(prior, axis, mode) = sprintf("< awk '$1 == \"%s\" && $2 == \"%s\" && $4 == \"%s\"' plot.dat", prior, axis, mode)
are_there(axis) = system(sprintf("awk '$1 == \"good\" && $2 == \"%s\"' plot.dat | wc -l", axis)) > 12

do for [axis in "rate speed"] {
  if (are_there(axis)) {
    quantity = axis eq 'rate' ? 'peak angular rate' : 'speed'
    unit = axis eq 'rate' ? 'deg/s' : 'm/s'
    set xlabel sprintf('%s [%s]', quantity, unit)
    set ylabel 'RMSE [mm]'
    set style data yerrorlines
    set output 'results_'.axis.'_points.svg'
    set title 'Error of the undistorted points over the '.quantity.', industrial IMU'
    plot for [i=1:6] rows('good', axis, word(modes, i)) using 3:5:6 lw 1.5 pt 7 ps 0.5 lc rgb color[i] \
           title word(modes, i), noise with lines lw 1 dt 3 lc rgb 'black' title 'range noise'
    set output 'results_'.axis.'_ate.svg'
    set title 'ATE over the '.quantity.', industrial IMU'
    plot for [i=1:6] rows('good', axis, word(modes, i)) using 3:7:8 lw 1.5 pt 7 ps 0.5 lc rgb color[i] \
           title word(modes, i)
  }
}

# The priors side by side, at 180 deg/s.
priors = 'good 100hz consumer bias offset all'
place(prior) = sum [i=1:words(priors)] (word(priors, i) eq prior ? i : 0)
at(rate, mode) = sprintf("< awk '$2 == \"rate\" && $3 == %d && $4 == \"%s\"' plot.dat", rate, mode)
if (system("awk '$2 == \"rate\" && $3 == 180' plot.dat | wc -l") > 12) {
  unset xlabel
  set xrange [0.4:6.6]
  set yrange [0.5:*]
  set xtics ('good' 1, '100 Hz' 2, 'consumer' 3, 'bias' 4, '5 ms late' 5, 'all' 6)
  set style data boxerrorbars
  set style fill solid 0.85 noborder
  set boxwidth 0.36
  set output 'results_priors_points.svg'
  set title 'Error of the undistorted points at 180 deg/s, by what is wrong with the prior'
  compared = 'imu iterated'
  array tint[2] = ['#1f5fa8', '#e0301f']
  plot for [i=1:2] at(180, word(compared, i)) using (place(strcol(1)) + (i - 1.5) * 0.4):5:6 lc rgb tint[i] \
         title word(compared, i), noise with lines lw 1 dt 3 lc rgb 'black' title 'range noise'
}
