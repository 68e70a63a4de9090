
function F = tabled(nu, delta)
% X Y Z K M N of the tables; not a number where one refuses to be read outside of its data.
U = norm(nu(1:3));  s = max(U, 1e-9);  b = 0;  refused = false;
a = atan2(nu(3) + 0, nu(1) + 0);
if U > 0, b = asin(max(-1, min(1, nu(2)/U))); end
base = [nu(:); delta(:); U; a; b];
[T, speaks] = tables();  D = zeros(6 + numel(speaks), 1);
for k = 1:numel(T)
  t = T(k);
  x = base(t.variables)';
  primed = t.prime ~= 0;
  x(primed) = x(primed).*t.prime(primed)/s;
  [near, free, inside] = held(t, x);
  refused = refused || (t.rule == 2 && ~inside && ~(t.rests && U <= 1e-9));
  for i = 1:size(t.terms, 1)
    r = t.terms(i,:);  n = r(4:2:end);  m = r(5:2:end);
    y = prod(near.^n .* abs(near).^m);
    if free > 0, y = y + free*(prod(x.^n .* abs(x).^m) - y); end
    if r(3) < 0, V = s; else, V = U; end
    D(r(1)) = D(r(1)) + r(2)*V^r(3)*y;
  end
end
turn = [-cos(a)*cos(b) -cos(a)*sin(b) sin(a); -sin(b) cos(b) 0; -sin(a)*cos(b) -sin(a)*sin(b) -cos(a)];
F = D(1:6);
F(1:3) = F(1:3) + sum(speaks'.*(turn*reshape(D(7:end), 3, [])), 2);
if refused, F(:) = NaN; end
end

function [near, free, inside] = held(t, x)
% The nearest point of the hull of a table's data, the share of the free continuation, and whether x is in the hull.
d = numel(x);  free = 0;
inside = all(t.spaces(:,1:d)*x' + t.spaces(:,end) <= 1e-9*max(1, abs(t.spaces(:,end))));
near = x;
if t.boxed, near = max(t.low, min(t.high, x)); end
if t.boxed || inside, return, end
size_ = t.high - t.low;  size_(size_ == 0) = 1;
y = ((x - t.low)./size_)';  best = Inf;
for k = 1:d:size(t.maps, 1)
  foot = t.maps(k:k+d-1, 1:d)*y + t.maps(k:k+d-1, end);
  if all(t.faces(:,1:d)*foot - t.faces(:,end) <= 1e-9) && norm(foot - y) < best
    best = norm(foot - y);  near = t.low + size_.*foot';
  end
end
if isinf(best), near(:) = NaN; end
if t.rule == 1 && best < 0.1 && ~any(t.low == t.high & near ~= x)
  w = best/0.1;  free = 1 - w^2*(3 - 2*w);
end
end
