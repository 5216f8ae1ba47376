"""The column under its own weight, restored in every step, with a form of the gradients."""
from forms import *
def column(ny,k,scheme,geom,steps=40,l0=50.,E=1e4,rho=80.,g=10.,ncol=2,seed=1,jit=.2,**kw):
    h=l0/ny; mesh=DM(np.linspace(0,ncol*h,ncol+1),np.linspace(0,l0,ny+1),jit=jit,seed=seed)
    P,W=seeds(k); xp=np.einsum('qa,ead->eqd',P,mesh.X[mesh.T[:,:3]]).reshape(-1,2); V0=(mesh.A[:,None]*W).ravel()
    Wd=ncol*h; X=mesh.X
    fx=np.where((X[:,0]<1e-9)|(X[:,0]>Wd-1e-9))[0]; fy=np.where(X[:,1]<1e-9)[0]; fixed=np.r_[2*fx,2*fy+1]
    gm=geom
    if geom=='exact': gm=lambda mesh,x,Vn: (Vn.sum()/Wd-mesh.X[:,1])/h
    r=run(mesh,xp,V0,rho,g,E,0.,fixed,steps,scheme,gm,**kw)
    if r['err'] is None: return r
    ex=-rho*g*(l0-xp[:,1]); r['err']=(abs(r['sig'][:,1,1]-ex)*V0).sum()/(rho*g*l0*V0.sum())
    sx=r['sig'][:,0,0]; r['sx']=(abs(sx)*V0).sum()/(rho*g*l0*V0.sum()); r['max']=abs(r['sig'][:,1,1]-ex).max()/(rho*g*l0)
    return r
