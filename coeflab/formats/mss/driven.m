
function F = driven(command)
% X Y Z K M N of the thrusters under their commands and tilts, those that are not given zero.
[T, S] = thrusters();
n = size(T, 1);  F = zeros(6,1);  c = zeros(2*n,1);  c(1:numel(command)) = command;
for k = 1:n
  t = T(k,:);  along = t(4:6)';  axis = t(7:9)';  own = S(S(:,1) == k,:);
  if any(axis)
    a = max(t(10), min(t(11), c(n+k)));
    along = along*cos(a) + cross(axis, along)*sin(a) + axis*(axis'*along)*(1 - cos(a));
  end
  force = curve(own(own(:,2) == 0, 3:end), c(k))*along;
  torque = t(12)*curve(own(own(:,2) == 1, 3:end), c(k))*along;
  F = F + [force; cross(t(1:3)', force) + torque];
end
end

function y = curve(s, x)
% A polynomial between two commands, zero between segments, that of the end beyond.
y = 0;
if isempty(s), return, end
x = max(s(1,1), min(s(end,2), x));
k = find(s(:,1) <= x & x <= s(:,2), 1);
if ~isempty(k), y = s(k,3:end)*x.^(0:size(s,2)-3)'; end
end
