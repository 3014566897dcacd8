# SPDX-License-Identifier: GPL-3.0-or-later
# columns of x, y | awk -v dx=SPACING -f closest.awk: the distance of the closest pair over the spacing, by cells of one spacing.
function floor(x,   i) { i = int(x); return i > x ? i - 1 : i }
/^#/ { next }
{ X[++n] = $1; Y[n] = $2; a = floor($1/dx); b = floor($2/dx); next_of[n] = first[a, b]; first[a, b] = n; A[n] = a; B[n] = b }
END {
  least = 1e300
  for (i = 1; i <= n; i++) for (a = A[i] - 1; a <= A[i] + 1; a++) for (b = B[i] - 1; b <= B[i] + 1; b++)
    if ((a, b) in first) for (j = first[a, b]; j; j = next_of[j]) if (j < i) {
      r2 = (X[i] - X[j])^2 + (Y[i] - Y[j])^2
      if (r2 < least) least = r2
    }
  print sqrt(least)/dx
}
