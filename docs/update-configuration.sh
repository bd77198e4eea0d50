#!/usr/bin/env bash
# Writes docs/configuration.md from what the program itself says of its keys.
set -euo pipefail
cd "$(dirname "$0")/.."
show() { build/release/bin/taut-slam --show-config "$@"; }
section() { sed -n "/^$1:/,/^[^ ]/{/^$1:/p;/^ /p}"; }
{
  cat <<'END'
# Configuration

Every key with its default, unit and meaning. Written by `docs/update-configuration.sh` out of

    build/release/bin/taut-slam --show-config

A method file (`-c`) gives the keys that differ; `-s SECTION.KEY=VALUE` overrides one; an unknown key is an error that
names it. `config.yaml` in the folder of results has all of them as they took effect. `type` names the class
of a plug point; the other keys of such a section are those of the class.

## config/default.yaml
```yaml
END
  show
  cat <<'END'
```

## Sections of the other classes
`features.type: taut::CurvatureExtractor`, `map.type: taut::KdTreeMap`, `solver.type: taut::NloptSolver`:
```yaml
END
  others=$(show -c config/paper.yaml -s solver.type=taut::NloptSolver)
  for name in features solver map; do section $name <<<"$others"; done
  cat <<'END'
```

## Values that are names
END
  for key in estimation.undistortion estimation.previous_state initialization.on_motion lidar.kernel; do
    known=$(show -s "$key=?" 2>&1 || true)
    echo "- \`$key\`: $(sed -n 's/.*choose from: //p' <<<"$known" | head -1)"
  done
  cat <<'END'

## Rig files
`-r RIG.yaml` overrides what the log says of the sensors: poses, noise, units and clocks.
[config/rig-example.yaml](../config/rig-example.yaml) has every key.
END
} >docs/configuration.md.new
mv docs/configuration.md.new docs/configuration.md
