#!/usr/bin/env bash
# Stands in for bench where tests of job scripts need a sweep that takes a known time, or fails when told to.
# A sweep has POINTS points of 0.1 s each. SIGTERM: what there is is kept, exit 130. With --resume it goes on there.
# Every start is a line of calls.txt: shard, points already there, threads; arguments in calls.SHARD, one a line, the process
# in pid.SHARD.
set -u
if [[ $1 == merge ]]; then
  shift
  echo "merge" >>calls.txt
  cat "${@:1:$#-2}" >"${!#}"  # without --out FILE
  exit
fi
resume=false
for ((i = 1; i <= $#; ++i)); do
  next=$((i + 1))
  case ${!i} in
    --shard) shard=${!next} ;;
    --out) out=${!next} ;;
    --resume) resume=true ;;
  esac
done
name=${shard%/*}
printf '%s\n' "$@" >"calls.$name"
echo $$ >"pid.$name"
[[ -s $out ]] && $resume && { echo "$name complete" >>calls.txt; exit; }
part=$out.part
$resume || rm -f "$part"
mkdir -p "${out%/*}"
touch "$part"
done_already=$(wc -l <"$part")
echo "$name at $done_already threads $OMP_NUM_THREADS $OPENBLAS_NUM_THREADS" >>calls.txt
[[ -e fail.$name ]] && exit 1
interrupted=false
trap 'interrupted=true' TERM
for ((point = done_already + 1; point <= POINTS; ++point)); do
  sleep 0.1
  $interrupted && { echo "$name interrupted" >>calls.txt; exit 130; }
  echo "shard $shard point $point" >>"$part"
done
mv "$part" "$out"
