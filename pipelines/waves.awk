# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f waves.awk -v errors=FILE KIND-dD-nN/wave.tsv...: amplitude against time in periods of the exact speed; the speed
# is that of its zeros, of which there are ten (in space four).
FNR == 1 { finish(); name = FILENAME; sub(/\/wave.tsv$/, "", name); sub(/.*\//, "", name); zeros = 0; last = "" }
{
  if (last != "" && last*$2 < 0) { t = before + ($1 - before)*last/(last - $2); if (!zeros++) first = t; end = t }
  last = $2; before = $1
}
function finish() { if (name) { c[++runs] = (zeros - 1)/2/(end - first); of[runs] = name; left[runs] = zeros } }
END {
  finish()
  title("Elastic waves in basalt: speed over the exact one")
  print "# spacing\tlongitudinal\ttransverse" > errors
  word["l"] = "longitudinal"; word["t"] = "transverse"; word["strip"] = "strip"; word["rod"] = "rod"
  for (r = 1; r <= runs; r++) {
    split(of[r], part, "-"); kind = part[1]; n = substr(part[3], 2) + 0; d = substr(part[2], 2)
    wide = kind == "strip" || kind == "rod" ? 0.03 : n >= 400 ? 0.005 : 0.015
    if (n >= 100 || d == 3 || wide == 0.03) claim(word[kind] ", " d "D, " n " particles a wave", c[r], 1 - wide, 1 + wide, "1", "")
    else fact(word[kind] ", " d "D, " n " particles a wave", c[r], "1", "")
    if (d == 2 && wide < 0.03) { m[kind]++; x[kind, m[kind]] = 1/n; error[kind, m[kind]] = abs(c[r] - 1) }
  }
  for (j = 1; j <= m["l"]; j++) print x["l", j] "\t" error["l", j] "\t" error["t", j] > errors
  for (k = split("l t", both, " "); k; k--) {
    for (j = 1; j <= m[both[k]]; j++) { dx[j] = x[both[k], j]; e[j] = error[both[k], j] }
    claim("order of convergence, " word[both[k]], order(dx, e, m[both[k]]), 1.5, 3, "2", "spacing and support together")
  }
}
