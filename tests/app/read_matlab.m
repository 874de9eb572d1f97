% Compares an exported MATLAB file with the native table: read_matlab.m FILE.mat TABLE.csv. Prints how many numbers agree.
arguments = argv();
s = load(arguments{1});
file = fopen(arguments{2});
lines = 0;
while true
  line = fgetl(file);
  lines = lines + 1;
  if line(1) != '#', break, end
end
fclose(file);
t = dlmread(arguments{2}, ',', lines, 0);
assert(strcmp(s.provenance.mesh, 'ring_planet'));
[R, P, L] = size(s.lte_m);
assert([R P L] == [numel(s.ring_angle_deg) numel(s.mesh_phase) numel(s.load_N)]);
count = 0;
for r = 1:R
  for p = 1:P
    for l = 1:L
      row = t(((r - 1) * P + p - 1) * L + l, :);
      expected = [s.mesh_phase(p) s.ring_angle_deg(r) s.load_N(l) s.unloaded_te_m(r, p, l) s.lte_m(r, p, l) ...
                  s.stiffness_secant_N_per_m(r, p, l) s.stiffness_tangent_N_per_m(r, p, l)];
      assert(all(abs(row(1:7) - expected) <= 1e-15 * abs(expected)));
      count = count + 7;
    end
  end
end
printf('%d\n', count);
