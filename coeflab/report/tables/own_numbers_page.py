"""A parameter file of one's own numbers, explained: the part of the schema's page that people write by."""

from __future__ import annotations

OWN_NUMBERS = """
## A file of your own numbers

`coeflab params new` writes one. It works out `value_si`, `unit_si`, `mass_prime` and the covariance, and refuses what does not fit. The
numbers on this page are placeholders, of no vehicle:

<!-- nothing -->
```console
$ coeflab params new placeholder --about cg --length "2 m" --speed "1 m/s" --density 1000 --mass "40 kg" --inertia 12 \\
> --set "Yv'=-0.03 +- 0.003" --set "Nv'=-0.012" --set "Yr'=0.005" --set "Nr'=-0.006" --set "Yvdot'=-0.009" --set "Nrdot'=-0.0005"
```

`"Yv=-60 N/(m/s)"`, without the prime, is an SI value, and goes with the speed as its prime does; the file says so. With `constant` behind
the unit it is the same at every speed (`law` "rest"), with `scaled` no remark is left. `--help` lists what else it takes: centre of gravity, moments of inertia, buoyancy.
By hand, this is enough:

```json title="by_hand.parameters.json"
{
  "schema_version": "1.5",
  "name": "by_hand",
  "body": "placeholder, bare hull",
  "scaling": {"length": 2.0, "length_name": "LOA"},
  "reference_point": {"point": [0.0, 0.0, 0.0], "datum": "cg"},
  "conditions": {"density": 1000.0, "speed": 1.0},
  "mass": {"mass": 40.0, "mass_moment": 0.0, "inertia": 12.0, "mass_prime": 0.01, "mass_moment_prime": 0.0},
  "coefficients": [
    {"symbol": "Yv'", "value": -0.03, "u95": 0.003, "unit": "1", "value_si": -60.0, "unit_si": "N/(m/s)", "status": "stated", "origin": "stated", "parts": {}},
    {"symbol": "Nv'", "value": -0.012, "u95": null, "unit": "1", "value_si": -48.0, "unit_si": "N*m/(m/s)", "status": "stated", "origin": "stated", "parts": {}},
    {"symbol": "Yr'", "value": 0.005, "u95": null, "unit": "1", "value_si": null, "unit_si": "N/(rad/s)", "status": "stated", "origin": "stated", "parts": {}},
    {"symbol": "Nr'", "value": -0.006, "u95": null, "unit": "1", "value_si": null, "unit_si": "N*m/(rad/s)", "status": "stated", "origin": "stated", "parts": {}},
    {"symbol": "Yvdot'", "value": -0.009, "u95": null, "unit": "1", "value_si": -36.0, "unit_si": "N/(m/s^2)", "status": "stated", "origin": "stated", "parts": {}},
    {"symbol": "Nrdot'", "value": -0.0005, "u95": null, "unit": "1", "value_si": null, "unit_si": "N*m/(rad/s^2)", "status": "stated", "origin": "stated", "parts": {}}
  ],
  "covariance": {"symbols": [], "matrix": []},
  "covered": [],
  "provenance": {"coeflab_version": "by hand", "study": "by hand", "inputs": [], "citations": [], "notes": ["placeholders, of no vehicle"]}
}
```

<!-- nothing -->
```console
$ coeflab params check by_hand.parameters.json
```

- `value` is the prime. `value_si` is the same at `conditions`, or null; where both stand they have to agree to 1e-6, and so have `mass` and
  `mass_prime`. Here 1/2 rho U L^2 = 2000 N/(m/s) makes Yv' = -0.03 to -60, and 1/2 rho L^3 = 4000 kg makes 40 kg to m' = 0.01.
- `unit_si` is that of the symbol. `N*m/(m/s)`, `Nm/(m/s)` and `N m s/m` are one.
- A number of your own has the status and the origin `stated`; the status `ok` says that a U95 exists, and `literature` that a work
  printed it (`citation`).
- `parts`, `covariance`, `covered` and `inputs` may be empty, as here. Then no range of data is stated, every motion counts as
  extrapolated, and `coeflab uncertainty` has nothing to draw from: it needs the covariance, which `coeflab params new` fills.
- Added mass: single numbers, measured or printed, as coefficients (`Yvdot'`, negative); a whole matrix, computed from the
  shape, in `added_mass` (positive). Where both give an entry the coefficient is used, the matrix for the rest, and
  `coeflab params check` notes that they differ. A coefficient off the diagonal (`Yrdot'`) counts for its mirror (`Nvdot'`), too.
- `inertia` is the transverse moment alone, `inertia_matrix` has all and needs `centre`. Both are about the reference point. Where both
  stand `inertia_matrix` is used. Motion in six degrees of freedom needs the matrix; v and r need either.
- What has no coefficient has no force. With these six, only v and r may move; exports say so.
"""
